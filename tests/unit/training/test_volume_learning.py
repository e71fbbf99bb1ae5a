"""The correction of a trained term for volume, on the packaged woman."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.meshes import enclosed_volume
from fitter.parameters import BodyParameters
from fitter.training.articulation.poses import random_pose
from fitter.training.articulation.volume_learning import with_volume_learned

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


def test_bodies_that_were_asked_for_keep_their_volume():
    before, after = (np.sqrt(np.mean(gains(each) ** 2)) for each in (model(), learned()))
    assert before > 0.005
    assert after < 0.4 * before


def test_the_skin_hardly_moves():
    first, second = ScapeEvaluator(model()), ScapeEvaluator(learned())
    moved = [
        np.linalg.norm(posed(first, *each) - posed(second, *each), axis=1).mean()
        for each in zip(*samples(), strict=True)
    ]
    assert 1e-5 < np.mean(moved) < 0.006


def test_bodies_at_rest_and_all_else_of_the_model_stay():
    for name in ("mean_vertices", "shape_basis", "triangle_weights", "pose_feature_joints"):
        np.testing.assert_array_equal(getattr(model(), name), getattr(learned(), name))
    at_rest = posed(ScapeEvaluator(learned()), np.zeros((17, 3)), np.zeros(20))
    np.testing.assert_allclose(at_rest, model().mean_vertices, atol=1e-5)


def test_the_same_draws_give_the_same_model():
    few = [
        with_volume_learned(model(), np.random.default_rng(1), samples=3).pose_feature_strengths
        for _ in range(2)
    ]
    np.testing.assert_array_equal(*few)
    assert np.abs(few[0] - model().pose_feature_strengths).max() > 0.0


def test_a_term_that_is_not_there_cannot_be_corrected():
    none = replace(model(), pose_right_hand_sides=np.zeros_like(model().pose_right_hand_sides))
    same = with_volume_learned(none, np.random.default_rng(1), samples=3)
    assert not same.pose_right_hand_sides.any()
    assert np.isfinite(same.pose_feature_strengths).all()
    assert pytest.approx(none.pose_feature_strengths) == same.pose_feature_strengths
