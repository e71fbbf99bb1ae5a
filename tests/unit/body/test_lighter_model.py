"""The body of the searches beside the whole body that it stands for."""

import numpy as np
import pytest
import trimesh

from fitter.body.lighter_model import LighterModel, lighter_model
from fitter.body.model import BodyModel, regress
from fitter.body.scape import ScapeEvaluator
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters

TRUNK_AND_THIGHS = ("pelvis", "spine", "chest", "left_thigh", "right_thigh")
BODIES = 6


@pytest.fixture(scope="module", params=["female", "male"])
def whole(request) -> BodyModel:
    return load_body_model(packaged_model_path(request.param))


@pytest.fixture(scope="module")
def lighter(whole) -> LighterModel:
    return lighter_model(whole)


def bodies(model: BodyModel) -> list[BodyParameters]:
    rng = np.random.default_rng(5)
    return [
        BodyParameters(
            pose=rng.normal(scale=0.2, size=(len(model.part_names), 3)),
            translation=np.array([0.1, -0.2, 4.0]),
            shape=rng.normal(size=len(model.shape_basis)),
        )
        for _ in range(BODIES)
    ]


@pytest.fixture(scope="module")
def posed(whole, lighter) -> list[tuple[np.ndarray, np.ndarray]]:
    """The same bodies, whole and lighter."""
    one, other = ScapeEvaluator(whole), ScapeEvaluator(lighter.model)
    return [(one.vertices(each), other.vertices(each)) for each in bodies(whole)]


def test_it_has_less_than_half_of_the_vertices_on_a_closed_surface(whole, lighter):
    model = lighter.model
    assert len(model.mean_vertices) == len(lighter.kept) < 0.45 * len(whole.mean_vertices)
    mesh = trimesh.Trimesh(model.mean_vertices, model.triangles, process=False)
    assert mesh.is_watertight
    assert mesh.euler_number == 2


def test_its_surface_lies_neither_inside_nor_outside_the_whole_one(whole, lighter):
    of_whole = trimesh.Trimesh(whole.mean_vertices, whole.triangles, process=False)
    of_lighter = trimesh.Trimesh(
        lighter.model.mean_vertices, lighter.model.triangles, process=False
    )
    assert of_lighter.volume == pytest.approx(of_whole.volume, rel=1e-3)
    _, distances, _ = trimesh.proximity.closest_point_naive(of_lighter, whole.mean_vertices[::40])
    assert np.percentile(distances, 95) < 1e-3


def test_posed_bodies_of_any_shape_are_the_same_to_a_millimetre(whole, lighter, posed):
    dominant = whole.skinning_parts[
        np.arange(len(whole.mean_vertices)), whole.skinning_weights.argmax(axis=1)
    ][lighter.kept]
    inner = np.isin(dominant, [whole.part_names.index(name) for name in TRUNK_AND_THIGHS])
    for one, other in posed:
        apart = 1000.0 * np.linalg.norm(other - one[lighter.kept], axis=1)
        assert apart.mean() < 1.0
        assert apart[inner].mean() < 0.6
        assert apart.max() < 8.0


def test_joints_and_landmarks_are_where_the_whole_body_has_them(whole, lighter, posed):
    for rows, moved, limit_mm in (
        (whole.joint_regressor, lighter.model.joint_regressor, 2.5),
        (whole.landmarks, lighter.model.landmarks, 4.0),
    ):
        assert moved.names == rows.names
        for one, other in posed:
            apart = 1000.0 * np.linalg.norm(regress(rows, one) - regress(moved, other), axis=1)
            assert apart.max() < limit_mm
    at_rest = regress(lighter.model.joint_regressor, lighter.model.mean_vertices)
    np.testing.assert_allclose(
        at_rest, regress(whole.joint_regressor, whole.mean_vertices), atol=2e-4
    )


def test_turning_the_whole_body_turns_it_rigidly(lighter):
    model = lighter.model
    evaluator = ScapeEvaluator(model)
    shape = np.random.default_rng(3).normal(size=len(model.shape_basis))
    at_rest = evaluator.body_frame_vertices(
        BodyParameters(
            pose=np.zeros_like(model.canonical_pose), translation=np.zeros(3), shape=shape
        )
    )
    expected = model.mean_vertices + np.tensordot(shape, model.shape_basis, axes=1)
    root = regress(model.joint_regressor, expected)[0]
    np.testing.assert_allclose(at_rest, expected - root, atol=2e-6)


def test_values_are_lifted_to_the_vertices_they_belong_to(whole, lighter):
    values = np.arange(1.0, len(lighter.kept) + 1.0)
    lifted = lighter.lifted(values)
    np.testing.assert_array_equal(lifted[lighter.kept], values)
    assert np.count_nonzero(lifted) == len(values)
    assert len(lifted) == len(whole.mean_vertices)
