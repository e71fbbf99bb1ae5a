"""Figures of bodies posed by a model, against bodies whose errors and volumes are known."""

from functools import cache
from itertools import islice

import numpy as np
import pytest

from fitter.arrays import Pose, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.meshes import enclosed_volume
from fitter.parameters import BodyParameters
from fitter.training.articulation.plausible_poses import (
    ADMITTED_DEGREES,
    excess_degrees,
    model_pose_prior,
    plausible_poses,
)
from fitter.training.articulation.random_poses import random_pose
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.report.articulation_figures import compared_poses, posed_volumes
from fitter.training.report.body_regions import vertex_regions

SHAPES = np.random.default_rng(3).normal(size=(2, 20))


@cache
def model() -> BodyModel:
    return load_body_model(packaged_model_path("female"))


@cache
def poses() -> list[Pose]:
    return list(islice(plausible_poses(model_pose_prior(model()), np.random.default_rng(4)), 4))


def bodies(growth: float, moved: str | None = None) -> RegisteredBodies:
    """Bodies of the model itself; posed ones grow, and a region of theirs moves by 10 mm."""
    evaluator = ScapeEvaluator(model())
    region = vertex_regions(model()).get(moved or "")

    def posed(subject: int, pose: Pose) -> Vertices:
        body = BodyParameters(pose=pose, translation=np.zeros(3), shape=SHAPES[subject])
        vertices = (1.0 + growth) ** (1 / 3) * evaluator.body_frame_vertices(body)
        if region is not None:
            vertices[region] += [0.0, 0.0, 0.01]
        return vertices

    rest = np.stack([rest_vertices(model(), shape) for shape in SHAPES])
    return RegisteredBodies(rest=rest, joints=np.zeros((2, 17, 3)), posed=posed)


def test_a_model_that_is_right_has_no_error_and_the_volume_that_was_taught():
    found = compared_poses(model(), bodies(0.0), poses())
    assert max(found.with_term.values()) < 0.01
    assert min(found.without_term.values()) > 3.0
    np.testing.assert_allclose(found.learned, found.taught, atol=1e-5)


def test_an_error_shows_in_the_region_that_has_it():
    found = compared_poses(model(), bodies(0.0, moved="feet"), poses())
    share = vertex_regions(model())["feet"].mean()
    assert found.with_term["feet"] == pytest.approx(10.0 * (1.0 - share), abs=0.05)
    assert found.with_term["arms"] == pytest.approx(10.0 * share, abs=0.05)


def test_growth_by_posing_is_told_as_taught_and_as_not_learned():
    right, grown = (compared_poses(model(), bodies(growth), poses()) for growth in (0.0, 0.02))
    np.testing.assert_allclose(grown.taught, 1.02 * (1.0 + right.taught) - 1.0, atol=1e-9)
    np.testing.assert_allclose(grown.learned, right.learned, atol=1e-9)


def test_at_rest_no_volume_is_gained_and_no_parts_touch():
    found = posed_volumes(model(), [np.zeros((17, 3))], np.random.default_rng(0))
    np.testing.assert_allclose([found.mean_body, found.drawn_bodies], 0.0, atol=1e-5)
    assert found.overlaps_m[0] <= 0.01


def test_the_volumes_are_those_of_the_posed_meshes():
    pose = poses()[0]
    found = posed_volumes(model(), [pose], np.random.default_rng(0))
    body = BodyParameters(pose=pose, translation=np.zeros(3), shape=np.zeros(20))
    posed = ScapeEvaluator(model()).body_frame_vertices(body)
    volumes = [enclosed_volume(each, model().triangles) for each in (posed, model().mean_vertices)]
    assert found.mean_body[0] == pytest.approx(volumes[0] / volumes[1] - 1.0, abs=1e-9)


def test_plausible_poses_keep_within_the_limits_that_others_leave():
    prior = model_pose_prior(model())
    assert max(excess_degrees(prior, pose) for pose in poses()) <= ADMITTED_DEGREES
    rng = np.random.default_rng(4)
    assert max(excess_degrees(prior, random_pose(rng)) for _ in range(20)) > ADMITTED_DEGREES
