"""Posed error by where the arms reach, against bodies whose errors are known."""

from functools import cache

import numpy as np
import pytest

from fitter.arrays import Pose, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.rotations import rotation_matrices
from fitter.parameters import BodyParameters
from fitter.training.articulation.arm_reaches import ARM_REACHES, with_arms_reaching
from fitter.training.articulation.part_tree import part_index
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.articulation.rig_drives import rest_axis
from fitter.training.report.raised_arm_figures import reach_error, shoulder_vertices

SHAPES = np.random.default_rng(3).normal(size=(2, 20))


@cache
def model() -> BodyModel:
    return load_body_model(packaged_model_path("female"))


def bodies(moved: Vertices) -> RegisteredBodies:
    """Bodies of the model itself, with some of their vertices moved when posed."""
    evaluator = ScapeEvaluator(model())

    def posed(subject: int, pose: Pose) -> Vertices:
        body = BodyParameters(pose=pose, translation=np.zeros(3), shape=SHAPES[subject])
        return evaluator.body_frame_vertices(body) + moved

    rest = np.stack([rest_vertices(model(), shape) for shape in SHAPES])
    return RegisteredBodies(rest=rest, joints=np.zeros((2, 17, 3)), posed=posed)


@pytest.mark.parametrize("name", ARM_REACHES)
def test_arms_reach_where_their_class_says_on_either_side(name: str):
    reach = ARM_REACHES[name]
    rng = np.random.default_rng(1)
    for side, outward in (("left", 1.0), ("right", -1.0)):
        arm = part_index(f"{side}_upper_arm")
        for _ in range(20):
            pose = with_arms_reaching(np.zeros((17, 3)), reach, rng)
            along = rotation_matrices(pose[[arm]])[0] @ rest_axis(f"{side}_upper_arm")
            elevation = np.degrees(np.arccos(-along[1]))
            azimuth = np.degrees(np.arctan2(along[2], outward * along[0]))
            assert reach.elevation[0] <= elevation <= reach.elevation[1]
            assert reach.azimuth[0] <= azimuth <= reach.azimuth[1]


def test_only_the_upper_arms_are_moved():
    pose = np.random.default_rng(0).normal(size=(17, 3))
    reach = ARM_REACHES["150 to 175 degrees"]
    changed = (with_arms_reaching(pose, reach, np.random.default_rng(0)) != pose).any(axis=1)
    arms = [part_index("left_upper_arm"), part_index("right_upper_arm")]
    np.testing.assert_array_equal(np.flatnonzero(changed), arms)


def test_an_error_of_the_shoulders_shows_there_and_in_its_share_everywhere():
    about = shoulder_vertices(model())
    reach = ARM_REACHES["120 to 150 degrees"]
    nothing, moved = np.zeros((2, len(about), 3))
    moved[about, 2] = 0.01
    right = reach_error(model(), bodies(nothing), reach, 3, np.random.default_rng(0))
    wrong = reach_error(model(), bodies(moved), reach, 3, np.random.default_rng(0))
    assert max(right.shoulders_95th, right.everywhere) < 0.01
    share = about.mean()
    assert wrong.shoulders == pytest.approx(10.0 * (1.0 - share), abs=0.01)
    assert wrong.everywhere == pytest.approx(20.0 * share * (1.0 - share), abs=0.01)
