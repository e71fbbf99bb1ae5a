"""Textbook ranges in a body's own rest pose."""

import numpy as np
import pytest

from fitter.body.joint_limits import JOINT_RANGES, range_of
from fitter.body.pose_prior import joint_angles, joint_energy, mean_pose, prior_terms
from fitter.numerics.rotations import compose, rotation_matrices
from tests.unit.pose_init.stick_figure import (
    PART_NAMES,
    mirrored_pose,
    stick_figure,
    stick_prior,
)

RIG = stick_figure()
PRIOR = stick_prior(RIG)


def turned_bone(part_name: str, angle: int, degrees: float) -> np.ndarray:
    """Where a part's bone points after turning about one anatomical axis alone."""
    part = RIG.part(part_name)
    child = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shin", "shin": "foot"}
    side, _, name = part_name.partition("_")
    bone = RIG.rest_joints[RIG.part(f"{side}_{child[name]}")] - RIG.rest_joints[part]
    turn = np.radians(degrees) * PRIOR.axes[part, angle]
    return rotation_matrices(turn[None])[0] @ (bone / np.linalg.norm(bone))


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize(
    ("name", "forward"), [("upper_arm", 1), ("forearm", 1), ("thigh", 1), ("shin", -1)]
)
def test_flexion_bends_limbs_forward_and_knees_backward(side, name, forward):
    straight = turned_bone(f"{side}_{name}", 0, 0.0)
    bent = turned_bone(f"{side}_{name}", 0, 40.0)
    assert forward * (bent - straight)[2] > 0.5


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("name", ["upper_arm", "thigh"])
def test_abduction_leads_away_from_the_middle(side, name):
    outward = 1.0 if side == "left" else -1.0
    moved = turned_bone(f"{side}_{name}", 1, 20.0) - turned_bone(f"{side}_{name}", 1, 0.0)
    assert outward * moved[0] > 0.1


@pytest.mark.parametrize(("side", "outward"), [("left", 1.0), ("right", -1.0)])
def test_positive_twist_turns_toes_outward(side, outward):
    axis = PRIOR.axes[RIG.part(f"{side}_thigh"), 2]
    toes = rotation_matrices(0.5 * axis[None])[0] @ [0.0, 0.0, 1.0]
    assert outward * toes[0] > 0.3


def test_axes_are_orthonormal():
    products = PRIOR.axes @ PRIOR.axes.transpose(0, 2, 1)
    np.testing.assert_allclose(products, np.tile(np.eye(3), (17, 1, 1)), atol=1e-12)


def test_arms_hang_close_to_the_trunk_at_the_mean():
    pose = mean_pose(PRIOR)
    part = RIG.part("left_upper_arm")
    bone = RIG.rest_joints[RIG.part("left_forearm")] - RIG.rest_joints[part]
    hanging = rotation_matrices(pose[part][None])[0] @ bone
    abduction = np.degrees(np.arctan2(hanging[0], -hanging[1]))
    assert abduction == pytest.approx(JOINT_RANGES["upper_arm"].abduction.mean, abs=1.0)


def test_the_mean_lies_within_the_limits_and_has_no_energy():
    assert (PRIOR.mean >= PRIOR.lower).all()
    assert (PRIOR.mean <= PRIOR.upper).all()
    np.testing.assert_allclose(prior_terms(PRIOR, mean_pose(PRIOR)).residuals, 0.0, atol=1e-12)


def test_the_root_turns_freely():
    pose = mean_pose(PRIOR)
    pose[0] = [0.3, 2.0, -1.0]
    np.testing.assert_allclose(prior_terms(PRIOR, pose).residuals, 0.0, atol=1e-12)


def test_every_part_but_the_root_has_a_range_with_its_source():
    for name in PART_NAMES[1:]:
        joint = range_of(name)
        assert joint is not None
        assert joint.source
    assert range_of("pelvis") is None


def test_a_knee_bent_forward_costs_more_than_one_bent_backward():
    part = RIG.part("left_shin")
    bend = np.radians(40.0) * PRIOR.axes[part, 0]
    assert joint_energy(PRIOR, part, -bend) > 20.0 * joint_energy(PRIOR, part, bend)


def test_jacobian_agrees_with_finite_differences_inside_and_beyond_the_limits():
    rng = np.random.default_rng(1)
    pose = mean_pose(PRIOR) + 0.7 * rng.standard_normal((17, 3))
    terms = prior_terms(PRIOR, pose)
    assert (terms.residuals[:, 3:] != 0.0).sum() > 5
    step = 1e-6
    for axis in range(3):
        ahead = np.tile(step * np.eye(3)[axis], (17, 1))
        slope = (
            prior_terms(PRIOR, compose(ahead, pose)).residuals
            - prior_terms(PRIOR, compose(-ahead, pose)).residuals
        ) / (2 * step)
        np.testing.assert_allclose(terms.jacobian[:, :, axis], slope, atol=1e-6, rtol=1e-6)


def test_energy_of_the_joints_is_half_the_sum_of_squares():
    rng = np.random.default_rng(2)
    pose = mean_pose(PRIOR) + 0.5 * rng.standard_normal((17, 3))
    whole = sum(joint_energy(PRIOR, part, pose[part]) for part in range(17))
    assert whole == pytest.approx(0.5 * (prior_terms(PRIOR, pose).residuals ** 2).sum())


def test_a_mirrored_pose_has_the_mirrored_angles():
    rng = np.random.default_rng(3)
    pose = mean_pose(PRIOR) + 0.4 * rng.standard_normal((17, 3))
    left, right = RIG.part("left_thigh"), RIG.part("right_thigh")
    mirrored = joint_angles(PRIOR, mirrored_pose(pose))
    np.testing.assert_allclose(mirrored[right], joint_angles(PRIOR, pose)[left], atol=1e-12)


def test_a_batch_gives_the_same_terms_as_its_members():
    rng = np.random.default_rng(4)
    poses = mean_pose(PRIOR) + 0.4 * rng.standard_normal((3, 17, 3))
    batch = prior_terms(PRIOR, poses)
    alone = prior_terms(PRIOR, poses[1])
    np.testing.assert_allclose(batch.residuals[1], alone.residuals)
    np.testing.assert_allclose(batch.jacobian[1], alone.jacobian)
