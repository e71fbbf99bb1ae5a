"""The tilt of the camera from bodies whose place in the world is known."""

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.energies import _body_kernels as kernels
from fitter.energies import stance as stances
from fitter.energies.stance import (
    CAMERA_HEIGHT_M,
    FORWARD_OF_ANKLES_M,
    most_probable_tilt,
    stance_rows,
    stance_vectors,
)
from fitter.fits.equipment import prepared_model
from fitter.parameters import BodyParameters, CameraTilt
from fitter.person.upright import upright_rotation
from fitter.training.articulation.parts import PART_NAMES, part_index
from fitter.vocabulary.choices import Gender, Posture
from fitter.vocabulary.outcomes import StanceKind

VECTORS = stance_vectors(PART_NAMES)
ANKLE_M = stances.ANKLE_HEIGHT_M

_PLACES = {
    "pelvis": (0.0, 0.95, 0.0),
    "spine": (0.0, 1.05, 0.0),
    "chest": (0.0, 1.2, 0.0),
    "neck": (0.0, 1.48, 0.0),
    "head": (0.0, 1.58, 0.0),
    "upper_arm": (0.18, 1.42, 0.0),
    "forearm": (0.22, 1.12, 0.0),
    "hand": (0.24, 0.86, 0.0),
    "thigh": (0.09, 0.92, 0.0),
    "shin": (0.1, 0.5, 0.0),
    "foot": (0.1, ANKLE_M, -FORWARD_OF_ANKLES_M),
}
"""A standing person in the world: x to their left, y up, z forward, metres."""


def standing_joints() -> np.ndarray:
    """(17, 3) with the centre of mass as far before the ankles as is usual, but for the feet."""
    joints = []
    for name in PART_NAMES:
        x, y, z = _PLACES[name.removeprefix("left_").removeprefix("right_")]
        joints.append((-x if name.startswith("right_") else x, y, z))
    return np.array(joints)


def tilted(pitch_deg: float, roll_deg: float) -> CameraTilt:
    return CameraTilt(
        pitch=np.radians(pitch_deg),
        roll=np.radians(roll_deg),
        covariance=np.eye(2),
        stances={StanceKind.STANDING: 1.0},
    )


def seen(joints: np.ndarray, tilt: CameraTilt, *, away_m: float = 3.0) -> np.ndarray:
    """World joints in the frame of a camera at the usual height, which the person faces."""
    eye = np.array([0.0, CAMERA_HEIGHT_M, away_m])
    return (joints - eye) @ upright_rotation(tilt)


def found(joints: np.ndarray) -> tuple[float, float]:
    tilt = most_probable_tilt(joints, VECTORS)
    return float(np.degrees(tilt.pitch)), float(np.degrees(tilt.roll))


def with_moved(joints: np.ndarray, **offsets: tuple[float, float, float]) -> np.ndarray:
    moved = joints.copy()
    for name, offset in offsets.items():
        moved[part_index(name)] += offset
    return moved


def kind_of(joints: np.ndarray) -> StanceKind:
    shares = most_probable_tilt(joints, VECTORS).shares
    assert shares.sum() == pytest.approx(1.0)
    return list(StanceKind)[int(np.argmax(shares))]


@pytest.mark.parametrize("pitch", [-14.0, -6.0, 0.0, 5.0])
def test_under_a_standing_person_the_cameras_pitch_is_found(pitch):
    assert found(seen(standing_joints(), tilted(pitch, 0.0))) == pytest.approx(
        (pitch, 0.0), abs=0.2
    )


def test_a_turned_camera_is_found_but_for_what_is_expected_of_cameras():
    _, roll = found(seen(standing_joints(), tilted(-6.0, 5.0)))
    assert 1.0 < roll < 5.0


def test_the_tilts_up_is_the_worlds():
    tilt = tilted(-11.0, 4.0)
    np.testing.assert_allclose(upright_rotation(tilt) @ tilt.up, [0.0, 1.0, 0.0], atol=1e-12)
    assert np.linalg.det(upright_rotation(tilt)) == pytest.approx(1.0)


def test_who_stands_stands_and_who_strides_strides():
    joints = standing_joints()
    assert kind_of(seen(joints, tilted(-6.0, 0.0))) is StanceKind.STANDING
    step = with_moved(joints, left_foot=(0.0, 0.05, -0.35), right_foot=(0.0, 0.0, 0.35))
    assert kind_of(seen(step, tilted(-6.0, 0.0))) is StanceKind.STRIDING


@pytest.mark.parametrize("degrees", [40.0, 90.0])
def test_who_lies_or_leans_far_is_not_set_upright(degrees):
    about = np.radians(degrees)
    turn = np.array(
        [[np.cos(about), np.sin(about), 0.0], [-np.sin(about), np.cos(about), 0.0], [0, 0, 1]]
    )
    fallen = seen(standing_joints() @ turn.T, tilted(-6.0, 0.0))
    assert kind_of(fallen) is StanceKind.OTHER
    _, roll = found(fallen)
    assert abs(roll) < 0.1 * degrees


def sitting_joints() -> np.ndarray:
    """On a chair 45 cm high, thighs forward, shins down."""
    joints = standing_joints() - [0.0, 0.45, 0.0]
    for side in ("left", "right"):
        hip, knee, foot = (part_index(f"{side}_{part}") for part in ("thigh", "shin", "foot"))
        joints[knee] = joints[hip] + [0.0, 0.0, 0.42]
        joints[foot] = joints[knee] + [0.0, ANKLE_M - joints[knee, 1], -0.05]
    return joints


def test_who_sits_does_not_stand_under_a_tilted_camera():
    joints = seen(sitting_joints(), tilted(-6.0, 0.0))
    assert kind_of(joints) is StanceKind.OTHER
    pitch, _ = found(joints)
    assert pitch == pytest.approx(-6.0, abs=5.0)


def test_no_pose_is_forced_to_stand():
    standing = most_probable_tilt(seen(standing_joints(), tilted(-6.0, 0.0)), VECTORS).energy
    sitting = most_probable_tilt(seen(sitting_joints(), tilted(-6.0, 0.0)), VECTORS).energy
    assert standing + 5.0 < sitting < standing + 25.0


def test_no_stance_costs_less_than_the_most_probable_one():
    rng = np.random.default_rng(5)
    joints = seen(standing_joints(), tilted(-3.0, 0.0))
    least = most_probable_tilt(joints, VECTORS).energy
    assert 0.0 <= least < 0.1
    for _ in range(20):
        moved = joints + 0.1 * rng.standard_normal(joints.shape)
        assert most_probable_tilt(moved, VECTORS).energy > least


def test_rows_are_the_energys_gradient():
    rng = np.random.default_rng(3)
    joints = seen(standing_joints(), tilted(-9.0, 2.0)) + 0.05 * rng.standard_normal((17, 3))
    tilt = most_probable_tilt(joints, VECTORS)
    rows = stance_rows(joints, VECTORS, tilt)
    gradient = np.einsum("k,kpc->pc", rows.weights * rows.residuals, rows.derivatives)
    for index in np.ndindex(joints.shape):
        step = np.zeros_like(joints)
        step[index] = 1e-5
        ahead = most_probable_tilt(joints + step, VECTORS).energy
        behind = most_probable_tilt(joints - step, VECTORS).energy
        assert gradient[index] == pytest.approx((ahead - behind) / 2e-5, abs=1e-3)


def test_at_the_most_probable_tilt_no_tilt_is_better():
    joints = seen(standing_joints(), tilted(-9.0, 2.0)) + 0.03
    tilt = most_probable_tilt(joints, VECTORS)
    rows = stance_rows(joints, VECTORS, tilt)
    assert rows.nuisance is not None
    pull = (rows.weights * rows.residuals) @ rows.nuisance.slopes
    np.testing.assert_allclose(pull, 0.0, atol=1e-3)


def test_the_tilt_found_is_the_best_of_a_fine_grid():
    rng = np.random.default_rng(9)
    angles = np.radians(np.linspace(-25.0, 25.0, 51))
    for _ in range(10):
        turned = seen(standing_joints(), tilted(rng.uniform(-15, 10), rng.uniform(-5, 5)))
        joints = turned + 0.08 * rng.standard_normal((17, 3))
        energies = [
            kernels.weigh(VECTORS @ joints, np.array([pitch, roll]), stances.KINDS[Posture.ANY])
            for pitch in angles
            for roll in angles
        ]
        tilt = most_probable_tilt(joints, VECTORS)
        assert tilt.energy <= min(each.energy for each in energies)


def test_the_centre_of_mass_is_that_of_the_bodys_volume():
    operators = prepared_model(Gender.MALE).operators
    body = BodyParameters(
        pose=operators.model.canonical_pose,
        translation=np.zeros(3),
        shape=np.zeros(len(operators.model.shape_basis)),
    )
    vertices = operators.evaluator.vertices(body)
    joints = regress(operators.model.joint_regressor, vertices)
    corners = vertices[operators.model.triangles]
    volumes = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    centre = volumes @ corners.sum(axis=1) / 4.0 / volumes.sum()
    by_joints = operators.stance_vectors[1] @ joints + operators.stance_vectors[4] @ joints
    # Joints lie behind and above the flesh that hangs on them.
    assert (np.abs(by_joints - centre) < [0.005, 0.05, 0.025]).all()
