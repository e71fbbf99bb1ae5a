"""Textbook ranges in a body's own rest pose."""

import re

import numpy as np
import pytest

from fitter.body.joint_limits import JOINT_RANGES, LIMIT_SOFTNESS_DEG, Motion, range_of
from fitter.body.pose_prior import (
    joint_angles,
    joint_energy,
    mean_pose,
    prior_residuals,
    prior_terms,
)
from fitter.numerics.rotations import compose, rotation_matrices
from fitter.training.articulation.poses import canonical_pose, standing_pose
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


def motions() -> dict[str, Motion]:
    return {
        f"{name} {direction}": getattr(joint, direction)
        for name, joint in JOINT_RANGES.items()
        for direction in ("flexion", "abduction", "twist")
    }


def test_every_part_but_the_root_has_a_range():
    for name in PART_NAMES[1:]:
        assert range_of(name) is not None
    assert range_of("pelvis") is None


@pytest.mark.parametrize(("name", "motion"), motions().items())
def test_every_limit_names_its_source_and_keeps_to_it(name, motion):
    published = re.findall(r"(AAOS|Kapandji [123]): ", motion.source)
    assert published or motion.source.startswith("ours: ")
    quoted = [float(number) for number in re.findall(r"(?<!Kapandji )\b\d+", motion.source)]
    if not published:
        assert motion.upper - motion.lower <= 16.0
    elif "in all" in motion.source:
        assert min(quoted) <= motion.upper - motion.lower <= max(quoted)
    elif "shared" not in motion.source:
        assert min(quoted) <= -motion.lower <= max(quoted)
        assert min(quoted) <= motion.upper <= max(quoted)


@pytest.mark.parametrize(
    ("parts", "direction", "total"),
    [
        (("spine", "chest"), "twist", (-40.0, 40.0)),
        (("neck", "head"), "flexion", (-75.0, 40.0)),
        (("neck", "head"), "abduction", (-45.0, 45.0)),
        (("neck", "head"), "twist", (-80.0, 80.0)),
    ],
)
def test_joints_that_share_a_published_range_add_up_to_it(parts, direction, total):
    shared = [motions()[f"{part} {direction}"] for part in parts]
    assert (sum(m.lower for m in shared), sum(m.upper for m in shared)) == total


def test_a_knee_bent_forward_costs_more_than_one_bent_backward():
    part = RIG.part("left_shin")
    bend = np.radians(40.0) * PRIOR.axes[part, :1]
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
    whole = sum(joint_energy(PRIOR, part, pose[part, None]).item() for part in range(17))
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


def clinical_pose(**angles: tuple[float, float, float]) -> np.ndarray:
    """A pose by each part's flexion, abduction and twist in degrees; other limbs hang straight."""
    pose = standing_pose(RIG.rest_joints)
    for part, degrees in angles.items():
        sides = [part] if part in PART_NAMES else [f"left_{part}", f"right_{part}"]
        for name in sides:
            index = RIG.part(name)
            at_rest = np.radians(range_of(name).flexion.mean) - PRIOR.mean[index, 0]
            offset = np.array([at_rest, *abduction_at_rest(name, index)])
            pose[index] = PRIOR.axes[index].T @ (np.radians(degrees) - offset)
    return pose


def abduction_at_rest(name: str, index: int) -> tuple[float, float]:
    joint = range_of(name)
    means = np.radians([joint.abduction.mean, joint.twist.mean])
    return tuple(means - PRIOR.mean[index, 1:])


def excess_degrees(pose: np.ndarray) -> float:
    """How far a pose leaves the limits, at its worst joint."""
    return float(np.abs(prior_residuals(PRIOR, pose)[:, 3:]).max() * LIMIT_SOFTNESS_DEG)


POSSIBLE = {
    "standing": standing_pose(RIG.rest_joints),
    "canonical": canonical_pose(RIG.rest_joints),
    "T-pose": clinical_pose(upper_arm=(0.0, 90.0, 0.0)),
    "arms raised": clinical_pose(upper_arm=(0.0, 170.0, 0.0)),
    "arms stretched forward": clinical_pose(upper_arm=(90.0, 0.0, 0.0)),
    "sitting": clinical_pose(thigh=(90.0, 5.0, 0.0), shin=(90.0, 0.0, 0.0)),
    "squat": clinical_pose(
        thigh=(115.0, 20.0, 10.0),
        shin=(135.0, 0.0, 0.0),
        foot=(15.0, 0.0, 0.0),
        spine=(30.0, 0.0, 0.0),
    ),
    "hands on hips": clinical_pose(upper_arm=(-10.0, 45.0, -30.0), forearm=(90.0, 0.0, 0.0)),
    "looking over a shoulder": clinical_pose(neck=(0.0, 0.0, 35.0), head=(0.0, 0.0, 35.0)),
    "bent forward": clinical_pose(spine=(50.0, 0.0, 0.0), chest=(40.0, 0.0, 0.0)),
}

IMPOSSIBLE = {
    "knees bent forward": clinical_pose(shin=(-40.0, 0.0, 0.0)),
    "elbows bent backward": clinical_pose(forearm=(-40.0, 0.0, 0.0)),
    "elbows bent sideways": clinical_pose(forearm=(20.0, 40.0, 0.0)),
    "head turned round": clinical_pose(neck=(0.0, 0.0, 90.0), head=(0.0, 0.0, 90.0)),
    "chin through the chest": clinical_pose(neck=(70.0, 0.0, 0.0)),
    "trunk turned round": clinical_pose(spine=(0.0, 0.0, 60.0)),
    "legs behind the back": clinical_pose(thigh=(-90.0, 0.0, 0.0)),
    "a split beyond the hips": clinical_pose(thigh=(0.0, 100.0, 0.0)),
    "toes on the shins": clinical_pose(foot=(70.0, 0.0, 0.0)),
    "wrists bent to the forearm": clinical_pose(hand=(130.0, 0.0, 0.0)),
    "hands turned round": clinical_pose(hand=(0.0, 0.0, 150.0)),
    "arms behind the back": clinical_pose(upper_arm=(-110.0, 0.0, 0.0)),
}


@pytest.mark.parametrize("name", POSSIBLE)
def test_what_people_do_lies_within_the_limits(name):
    assert excess_degrees(POSSIBLE[name]) < 1.0


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_what_nobody_can_do_lies_outside_the_limits(name):
    assert excess_degrees(IMPOSSIBLE[name]) > 20.0


@pytest.mark.parametrize(("side", "outward"), [("left", 1.0), ("right", -1.0)])
def test_a_wrist_bends_to_the_palm_and_to_the_thumb(side, outward):
    index = RIG.part(f"{side}_hand")
    bone = RIG.rest_joints[index] - RIG.rest_joints[RIG.part(f"{side}_forearm")]
    flexed, abducted = (
        rotation_matrices(np.radians(30.0) * PRIOR.axes[[index], angle])[0] @ bone - bone
        for angle in (0, 1)
    )
    # The palm faces the body, the thumb is in front.
    assert outward * flexed[0] < 0.0
    assert abducted[2] > 0.0


def test_pronation_is_the_hands_and_not_the_elbows():
    assert JOINT_RANGES["hand"].twist.upper == 80.0
    assert JOINT_RANGES["forearm"].twist.upper < 10.0
