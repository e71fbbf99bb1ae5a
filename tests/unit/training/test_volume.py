"""Volume of MakeHuman's neutral woman in extreme poses, with and without what keeps it."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fitter.arrays import Pose
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.meshes import enclosed_volume
from fitter.parameters import BodyParameters
from fitter.training.articulation.parts import PART_NAMES, PART_PARENT, part_index
from fitter.training.articulation.poses import random_pose
from fitter.training.articulation.rig import bone_heads, posed_vertices
from fitter.training.articulation.volume import volume_change, with_volume_learned
from tests.unit.training.makehuman_data import needs_makehuman
from tests.unit.training.rigged_neutral import mesh, neutral_body, neutral_source, rig

pytestmark = needs_makehuman

KEPT = 0.005
"""Share of the volume that may be gained or lost."""


def skinned(pose: Pose) -> np.ndarray:
    heads = bone_heads(rig(), neutral_source())
    return posed_vertices(rig(), mesh().skin, neutral_body().rest[0], heads, pose)


def gain(vertices: np.ndarray) -> float:
    triangles = mesh().surface.triangles
    at_rest = enclosed_volume(neutral_body().rest[0], triangles)
    return enclosed_volume(vertices, triangles) / at_rest - 1.0


DEGREES = {
    "shoulder raised": {"left_upper_arm": (0.0, 0.0, 120.0)},
    "shoulder crossed in front": {"left_upper_arm": (-30.0, -90.0, 0.0)},
    "elbow bent": {"left_forearm": (-60.0, -75.0, 0.0)},
    "hip flexed": {"left_thigh": (-110.0, 0.0, 0.0)},
    "hip abducted": {"left_thigh": (0.0, 0.0, 50.0)},
    "knee bent": {"left_shin": (135.0, 0.0, 0.0)},
    "spine bent": {"spine": (40.0, 0.0, 0.0), "chest": (30.0, 0.0, 0.0)},
    "spine arched": {"spine": (-15.0, 0.0, 0.0), "chest": (-15.0, 0.0, 0.0)},
    "spine leaning": {"spine": (0.0, 0.0, 20.0), "chest": (0.0, 0.0, 15.0)},
    "spine twisted": {"spine": (0.0, 20.0, 0.0), "chest": (0.0, 25.0, 0.0)},
}
"""Turns at the ends of the ranges of motion, in which articulation fails first."""


def extreme(name: str) -> Pose:
    pose = np.zeros((len(PART_NAMES), 3))
    for part, degrees in DEGREES[name].items():
        pose[part_index(part)] = np.radians(degrees)
    return pose


def test_skinning_alone_takes_and_adds_flesh():
    gains = {name: gain(skinned(extreme(name))) for name in DEGREES}
    assert gains["spine bent"] < -0.03
    assert gains["hip flexed"] < -0.01
    assert gains["shoulder raised"] > 0.015


@pytest.mark.parametrize("name", DEGREES)
def test_extreme_poses_keep_the_volume(name):
    assert abs(gain(neutral_body().posed(0, extreme(name)))) < KEPT


def test_at_rest_nothing_moves():
    at_rest = neutral_body().posed(0, np.zeros((len(PART_NAMES), 3)))
    np.testing.assert_allclose(at_rest, neutral_body().rest[0], atol=1e-9)


def test_what_comes_out_comes_out_at_the_joint():
    pose = np.zeros((len(PART_NAMES), 3))
    pose[part_index("left_thigh"), 0] = -1.6
    moved = np.linalg.norm(neutral_body().posed(0, pose) - skinned(pose), axis=1)
    rest, joints = neutral_body().rest[0], neutral_body().joints[0]
    from_hip = np.linalg.norm(rest - joints[part_index("left_thigh")], axis=1)
    assert moved[from_hip < 0.15].max() > 0.003
    assert moved[from_hip > 0.45].max() < 1e-9


@pytest.mark.parametrize("name", ["left_thigh", "right_upper_arm", "spine"])
def test_a_joints_own_change_is_that_of_the_whole_body(name):
    about = next(a for a in mesh().surroundings if PART_NAMES[a.part] == name)
    pose = np.zeros((len(PART_NAMES), 3))
    pose[part_index(name)] = [-1.3, 0.0, 0.0]
    heads = bone_heads(rig(), neutral_source())
    rest = neutral_body().rest[0]
    found = volume_change(rig(), about, rest, heads, pose)
    whole = gain(skinned(pose)) * enclosed_volume(rest, mesh().surface.triangles)
    assert found == pytest.approx(whole, rel=1e-6, abs=1e-10)
    assert abs(found) > 1e-5


def test_all_joints_but_those_of_rigid_ends_are_watched():
    watched = {PART_NAMES[about.part] for about in mesh().surroundings}
    ends = {name for name in PART_NAMES if name.endswith(("head", "hand", "foot"))}
    assert watched == {n for n in PART_NAMES if PART_PARENT[part_index(n)] >= 0} - ends


def test_shares_run_from_none_to_all_of_a_turn():
    for about in mesh().surroundings:
        assert about.share.min() == pytest.approx(0.0, abs=1e-9)
        assert about.share.max() == pytest.approx(1.0, abs=1e-9)


SAMPLES = 30


@cache
def model() -> BodyModel:
    """With too little pose-dependent flesh, so that there is volume to be learned."""
    whole = load_body_model(packaged_model_path("female"))
    return replace(whole, pose_right_hand_sides=0.7 * whole.pose_right_hand_sides)


@cache
def learned() -> BodyModel:
    return with_volume_learned(model(), np.random.default_rng(8), samples=SAMPLES)


def samples() -> tuple[list[np.ndarray], np.ndarray]:
    """The poses and shapes that the correction draws."""
    rng = np.random.default_rng(8)
    poses = [random_pose(rng) for _ in range(SAMPLES)]
    return poses, rng.normal(size=(SAMPLES, len(model().shape_basis)))


def posed(evaluator: ScapeEvaluator, pose: np.ndarray, shape: np.ndarray) -> np.ndarray:
    return evaluator.body_frame_vertices(
        BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
    )


def gains(each: BodyModel) -> np.ndarray:
    evaluator = ScapeEvaluator(each)
    return np.array(
        [
            enclosed_volume(posed(evaluator, pose, shape), each.triangles)
            / enclosed_volume(rest_vertices(each, shape), each.triangles)
            - 1.0
            for pose, shape in zip(*samples(), strict=True)
        ]
    )


@pytest.mark.slow
def test_bodies_that_were_asked_for_keep_their_volume():
    before, after = (np.sqrt(np.mean(gains(each) ** 2)) for each in (model(), learned()))
    assert before > 0.005
    assert after < 0.4 * before


@pytest.mark.slow
def test_the_skin_hardly_moves():
    first, second = ScapeEvaluator(model()), ScapeEvaluator(learned())
    moved = [
        np.linalg.norm(posed(first, *each) - posed(second, *each), axis=1).mean()
        for each in zip(*samples(), strict=True)
    ]
    assert 1e-5 < np.mean(moved) < 0.006


@pytest.mark.slow
def test_bodies_at_rest_and_all_else_of_the_model_stay():
    for name in ("mean_vertices", "shape_basis", "triangle_weights", "pose_feature_joints"):
        np.testing.assert_array_equal(getattr(model(), name), getattr(learned(), name))
    at_rest = posed(ScapeEvaluator(learned()), np.zeros((17, 3)), np.zeros(20))
    np.testing.assert_allclose(at_rest, model().mean_vertices, atol=1e-5)


def test_a_term_that_is_not_there_cannot_be_corrected():
    none = replace(model(), pose_right_hand_sides=np.zeros_like(model().pose_right_hand_sides))
    same = with_volume_learned(none, np.random.default_rng(1), samples=3)
    assert not same.pose_right_hand_sides.any()
    assert np.isfinite(same.pose_feature_strengths).all()
    assert pytest.approx(none.pose_feature_strengths) == same.pose_feature_strengths
