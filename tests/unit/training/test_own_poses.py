"""Poses and pose terms of own bodies."""

import numpy as np
import pytest

from fitter.numerics.meshes import gradient_operator, part_laplacians, vertex_areas
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.training.articulation.parts import PART_NAMES
from fitter.training.articulation.poses import random_pose
from fitter.training.assemble import ShapeSpace
from fitter.training.own_bodies.pose_terms import (
    best_rotation,
    no_pose_term,
    refined_pose,
    solved_pose,
    transferred_pose_term,
)
from tests.unit.training.own_bodies_folder import (
    packaged,
    posed_body,
    random_shapes,
    template,
)

SHAPE = random_shapes(1, axes=0)[0]


def degrees_apart(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Angle between two poses, part by part."""
    between = rotation_matrices(first).transpose(0, 2, 1) @ rotation_matrices(second)
    return np.degrees(np.linalg.norm(rotation_vectors(between), axis=1))


def solve(scan: np.ndarray) -> np.ndarray:
    mesh = template().mesh
    areas = vertex_areas(template().vertices, mesh.triangles)
    return solved_pose(packaged().mean_vertices, scan, mesh.parts, areas)


def refine(pose: np.ndarray, scan: np.ndarray) -> np.ndarray:
    mesh = template().mesh
    areas = vertex_areas(template().vertices, mesh.triangles)
    return refined_pose(pose, lambda at: posed_body(SHAPE, at), scan, mesh.parts, areas)


def test_the_best_rotation_is_the_one_that_was_applied():
    rng = np.random.default_rng(0)
    points = rng.normal(size=(20, 3))
    rotation = rotation_matrices(rng.normal(size=(1, 3)))[0]
    found = best_rotation(points, points @ rotation.T + [1.0, 2.0, 3.0], rng.uniform(size=20))
    np.testing.assert_allclose(found, rotation, atol=1e-12)


def test_the_best_rotation_of_a_mirror_image_is_no_reflection():
    points = np.random.default_rng(0).normal(size=(20, 3))
    found = best_rotation(points, points * [-1.0, 1.0, 1.0], np.ones(20))
    assert np.linalg.det(found) == pytest.approx(1.0)


def test_a_turn_of_the_whole_body_is_the_root_s_alone():
    turn = np.array([0.2, 1.1, -0.4])
    scan = packaged().mean_vertices @ rotation_matrices(turn[None])[0].T + 0.7
    expected = np.zeros((len(PART_NAMES), 3))
    expected[0] = turn
    np.testing.assert_allclose(solve(scan), expected, atol=1e-9)


def test_refining_brings_a_solved_pose_to_the_bones():
    pose = random_pose(np.random.default_rng(4))
    scan = posed_body(SHAPE, pose) + [0.3, 0.0, 1.0]
    solved = solve(scan)
    refined = refine(solved, scan)
    assert degrees_apart(refined, pose).mean() < 0.4 * degrees_apart(solved, pose).mean()
    assert degrees_apart(refined, pose).max() < 5.0


def test_a_true_pose_stays_where_it_is():
    pose = random_pose(np.random.default_rng(5))
    assert degrees_apart(refine(pose, posed_body(SHAPE, pose)), pose).max() < 1e-6


def space(mean: np.ndarray, basis: np.ndarray) -> ShapeSpace:
    model = packaged()
    return ShapeSpace(
        mean=mean,
        basis=basis,
        coefficients=np.zeros((1, len(basis))),
        laplacians=part_laplacians(
            gradient_operator(mean, model.triangles),
            model.triangle_weights,
            model.part_of_triangle,
            len(model.part_names),
        ),
    )


def test_a_term_taken_over_to_its_own_shape_space_is_itself():
    model = packaged()
    found = transferred_pose_term(space(model.mean_vertices, model.shape_basis), model)
    size = np.abs(model.pose_right_hand_sides).max()
    np.testing.assert_allclose(
        found.right_hand_sides, model.pose_right_hand_sides, atol=1e-4 * size
    )
    np.testing.assert_allclose(found.strengths, model.pose_feature_strengths, atol=1e-9)


def test_a_term_taken_over_to_another_mean_acts_there_as_it_did():
    """The new mean is the packaged body of some shape b: 1 + s . b there becomes 1 at its mean."""
    model = packaged()
    offset = np.zeros(len(model.shape_basis))
    offset[1] = 1.0
    mean = model.mean_vertices + model.shape_basis[1]
    found = transferred_pose_term(space(mean, model.shape_basis[:4]), model)
    at_mean = 1.0 + model.pose_feature_strengths @ offset
    kept = at_mean > 0.2
    np.testing.assert_allclose(
        (found.strengths * at_mean[..., None])[kept],
        model.pose_feature_strengths[..., :4][kept],
        atol=1e-6,
    )


def test_without_a_term_nothing_is_added():
    own = space(packaged().mean_vertices, packaged().shape_basis[:3])
    term = no_pose_term(own, template().mesh.parts)
    assert not term.right_hand_sides.any()
    assert term.strengths.shape[2] == 3
