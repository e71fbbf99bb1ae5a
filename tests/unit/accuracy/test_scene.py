"""People in place: poses by closed forms, lamp, joints and clicks beside the truth."""

import numpy as np
import pytest

from fitter.body.model import global_rotations, regress
from fitter.render.reflectance import light_position
from fitter.training.articulation.parts import PART_PARENT, part_index
from fitter.vocabulary.choices import Gender
from tests.accuracy.cases import CASES, PEOPLE
from tests.accuracy.clicks import CLICK_DEVIATION_PX, noisy_clicks, true_points
from tests.accuracy.people import load_person, packaged_model, rig_of_people
from tests.accuracy.scene import Arm, Leg, Stance
from tests.accuracy.staging import Staged, lamp_place, rendering, root_joint, stage
from tests.accuracy.stances import pose_of
from tests.accuracy.truth import true_body, true_joints, true_light
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = [pytest.mark.slow, needs_makehuman]


@pytest.fixture(scope="module")
def joints() -> np.ndarray:
    model = packaged_model(Gender.MALE)
    return regress(model.joint_regressor, model.mean_vertices)


def _direction(pose, joints, near, far):
    rotation = global_rotations(pose, PART_PARENT)[part_index(near)]
    bone = rotation @ (joints[part_index(far)] - joints[part_index(near)])
    return bone / np.linalg.norm(bone)


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_arm_of_no_angles_hangs_straight_down(joints, side):
    hanging = Arm(raised=0.0, bend=0.0)
    pose = pose_of(Stance(left_arm=hanging, right_arm=hanging), joints)
    for near, far in (("upper_arm", "forearm"), ("forearm", "hand")):
        direction = _direction(pose, joints, f"{side}_{near}", f"{side}_{far}")
        np.testing.assert_allclose(direction, [0.0, -1.0, 0.0], atol=1e-9)


@pytest.mark.parametrize("turn", [-60.0, 45.0])
def test_elbows_and_knees_bend_by_their_angles(joints, turn):
    arm, leg = Arm(raised=30.0, turn=turn, bend=70.0), Leg(raised=0.0, turn=0.0, bend=40.0)
    pose = pose_of(Stance(left_arm=arm, left_leg=leg), joints)
    elbow, knee = (
        (_direction(pose, joints, near, middle), _direction(pose, joints, middle, far))
        for near, middle, far in (
            ("left_upper_arm", "left_forearm", "left_hand"),
            ("left_thigh", "left_shin", "left_foot"),
        )
    )
    assert np.degrees(np.arccos(elbow[0] @ elbow[1])) == pytest.approx(70.0, abs=1e-6)
    # A knee's axis is square to the thigh but for its slight slope at rest.
    assert np.degrees(np.arccos(knee[0] @ knee[1])) == pytest.approx(40.0, abs=0.5)
    assert knee[1][2] < 0.0


def test_facing_turns_everything_about_the_vertical(joints):
    ahead, turned = (pose_of(Stance(facing=angle), joints) for angle in (0.0, 90.0))
    arm = "left_upper_arm", "left_forearm"
    x, y, z = _direction(ahead, joints, *arm)
    np.testing.assert_allclose(_direction(turned, joints, *arm), [z, y, -x], atol=1e-9)


def _staged(name: str) -> Staged:
    case = CASES[name]
    return stage(load_person(PEOPLE[case.person]), case)


@pytest.fixture(scope="module")
def demo() -> Staged:
    return _staged("demo")


def test_the_lamp_is_where_the_truth_says_in_the_fitters_terms(demo):
    centre = demo.in_camera(root_joint(demo))
    np.testing.assert_allclose(
        light_position(true_light(demo), centre),
        demo.in_camera(lamp_place(demo, demo.case.lighting.lamp)),
        atol=1e-9,
    )


def test_the_models_joints_on_the_true_body_are_the_rigs_joints(demo):
    found = true_joints(demo)[0]
    # People turn about cubes in the bone, the model about skin: a centimetre lies between.
    np.testing.assert_allclose(found, demo.in_camera(root_joint(demo)), atol=0.015)


def test_a_person_is_as_tall_and_heavy_as_their_mesh(demo):
    truth = true_body(demo.person)
    rest = rig_of_people().surface.body(demo.person.source_vertices)
    assert truth.measurements["stature"] / 100.0 == pytest.approx(np.ptp(rest[:, 1]), abs=0.03)
    a, b, c = (rest[rig_of_people().surface.triangles[:, k]] for k in range(3))
    volume = np.einsum("fx,fx->", a, np.cross(b, c)) / 6.0
    assert truth.measurements["weight"] == pytest.approx(1000.0 * volume, rel=0.02)


def test_clicks_scatter_about_the_true_points_by_their_deviation(demo):
    seen = rendering(demo)
    true = {name: demo.camera.project(point) for name, point in true_points(demo).items()}
    offsets = [
        (click["x"] - true[name][0], click["y"] - true[name][1])
        for seed in range(20)
        for name, click in noisy_clicks(demo, seen, np.random.default_rng(seed)).items()
    ]
    assert np.std(offsets) == pytest.approx(CLICK_DEVIATION_PX, rel=0.1)
    assert abs(np.mean(offsets)) < 0.3
