"""The reflectance of what is seen, and of what is hidden."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from fitter.numerics.meshes import mesh_topology
from fitter.numerics.surface_sample import elimination_order
from fitter.optimizer.hidden_reflectance import HiddenVertices
from fitter.optimizer.reflectance_solve import (
    ReflectanceFields,
    ReflectanceProblem,
    ReflectanceSolver,
    reflectance_energy,
)


@pytest.fixture(scope="module")
def scene() -> tuple[ReflectanceProblem, ReflectanceFields, ReflectanceFields]:
    """A lit sphere with two albedos, its truth and a uniform start."""
    sphere = trimesh.creation.icosphere(subdivisions=4)
    normals = np.asarray(sphere.vertices)
    light = np.array([0.3, 0.5, 0.8]) / np.linalg.norm([0.3, 0.5, 0.8])
    diffuse = np.maximum(normals @ light, 0.0)
    halfway = light + [0.0, 0.0, 1.0]
    specular = np.maximum(normals @ (halfway / np.linalg.norm(halfway)), 0.0) ** 12
    truth = ReflectanceFields(
        albedo=np.where(normals[:, 0] > 0.2, 0.3, 0.6),
        specularity=np.full(len(normals), 0.1),
        ambient=0.08,
    )
    intensity = truth.ambient + truth.albedo * diffuse + truth.specularity * specular
    topology = mesh_topology(sphere.faces.astype(np.int32), vertex_count=len(normals))
    visible = (normals[:, 2] > 0.1).astype(float)
    problem = ReflectanceProblem(
        diffuse=diffuse,
        specular=specular,
        intensity=intensity,
        weights=visible,
        edges=topology.edges,
        edge_lengths=np.ones(len(topology.edges)),
        ambient_limit=1.0,
        albedo_smoothness=1e-3,
        specularity_smoothness=1e-2,
        data_eta=0.1,
        albedo_eta=0.05,
        specularity_eta=0.05,
    )
    start = ReflectanceFields(
        albedo=np.full(len(normals), 0.4), specularity=np.full(len(normals), 0.05), ambient=0.0
    )
    return problem, truth, start


def solver_of(problem):
    order = elimination_order(problem.edges, len(problem.diffuse))
    return ReflectanceSolver(problem.edges, order)


def test_piecewise_constant_albedo_is_recovered_with_its_step(scene):
    problem, truth, start = scene
    solver = solver_of(problem)
    found = solver.solve(problem, start, iterations=40)
    lit = (problem.weights > 0) & (problem.diffuse > 0.3)
    error = np.abs(found.albedo - truth.albedo)[lit]
    assert np.median(error) < 0.02
    assert np.percentile(error, 95) < 0.06


def test_the_energy_never_rises(scene):
    problem, _, start = scene
    solver = solver_of(problem)
    energies = [reflectance_energy(problem, start)]
    energies += [
        reflectance_energy(problem, solver.solve(problem, start, iterations=iterations))
        for iterations in (1, 2, 4, 8)
    ]
    assert all(after <= before for before, after in itertools.pairwise(energies))
    assert energies[-1] < 0.1 * energies[0]


def test_unseen_vertices_take_their_reflectance_from_their_neighbours(scene):
    problem, truth, start = scene
    solver = solver_of(problem)
    uniform = replace(
        problem,
        intensity=truth.ambient + 0.5 * problem.diffuse + 0.1 * problem.specular,
    )
    found = solver.solve(uniform, start, iterations=40)
    hidden = problem.weights == 0
    assert np.abs(found.albedo[hidden] - 0.5).max() < 0.05


def test_a_negative_reflectance_is_never_returned(scene):
    problem, _, start = scene
    solver = solver_of(problem)
    found = solver.solve(replace(problem, intensity=0.0 * problem.intensity), start, iterations=10)
    assert found.albedo.min() >= 0.0
    assert found.specularity.min() >= 0.0
    assert found.ambient >= 0.0


def test_ambient_light_never_exceeds_its_limit(scene):
    problem, _, start = scene
    solver = solver_of(problem)
    found = solver.solve(replace(problem, ambient_limit=0.02), start, iterations=20)
    assert found.ambient <= 0.02


EDGES = np.array([[k, k + 1] for k in range(5)])
LENGTHS = np.array([1.0, 1.0, 2.0, 1.0, 1.0])


def test_between_two_known_values_the_unknown_run_evenly_with_the_distance():
    known = np.array([True, True, False, False, True, True])
    values = np.array([0.2, 0.2, 9.0, 9.0, 0.6, 0.6])
    found = HiddenVertices.of(known, EDGES, LENGTHS).filled(values)
    np.testing.assert_allclose(found, [0.2, 0.2, 0.3, 0.5, 0.6, 0.6], atol=1e-5)


def test_beyond_the_last_known_value_it_goes_on_unchanged():
    known = np.array([True, True, True, False, False, False])
    values = np.array([0.1, 0.4, 0.3, 9.0, 9.0, 9.0])
    found = HiddenVertices.of(known, EDGES, LENGTHS).filled(values)
    np.testing.assert_allclose(found[3:], 0.3, atol=1e-4)


def test_what_touches_nothing_known_takes_the_mean():
    known = np.array([True, True, False, False])
    values = np.array([0.2, 0.4, 9.0, 9.0])
    pairs = np.array([[0, 1], [2, 3]])
    found = HiddenVertices.of(known, pairs, np.ones(2)).filled(values)
    np.testing.assert_allclose(found[2:], 0.3)


def test_what_is_known_stays_and_nothing_unknown_changes_nothing():
    values = np.array([0.2, 0.4, 0.5, 0.1, 0.3, 0.6])
    found = HiddenVertices.of(np.ones(6, dtype=bool), EDGES, LENGTHS).filled(values)
    np.testing.assert_array_equal(found, values)


def test_one_factorisation_serves_every_field():
    known = np.array([True, True, False, False, True, True])
    first = np.array([0.2, 0.2, 9.0, 9.0, 0.6, 0.6])
    hidden = HiddenVertices.of(known, EDGES, LENGTHS)
    np.testing.assert_allclose(hidden.filled(2.0 * first), 2.0 * hidden.filled(first))
