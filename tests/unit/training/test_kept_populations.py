"""Where subjects come from: the folder that keeps them, or solving."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.articulation.joints import joint_errors_mm
from fitter.training.articulation.rigged_bodies import rigged_bodies
from fitter.training.build import GENDERS, Materials, read_materials, solved_population, subjects
from fitter.training.people.population import (
    PACKAGED_PEOPLE,
    Population,
    load_population,
    population_path,
    save_population,
)
from fitter.training.report.held_out_figures import shape_coefficients, shape_error
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = [pytest.mark.slow, needs_makehuman]

TOLERANCE_MM = 1e-3


@pytest.fixture(scope="module")
def materials() -> Mapping[str, Materials]:
    return read_materials()


@pytest.fixture(scope="module")
def women(materials) -> Materials:
    return materials["female"]


@pytest.fixture(scope="module")
def committed(women: Materials) -> Population:
    """A few of the committed women."""
    path = population_path(PACKAGED_PEOPLE, "female", 1)
    return load_population(path, women.space, count=6)


def keep(folder: Path, seed: int, population: Population) -> None:
    save_population(population_path(folder, "female", seed), population)


def same(one: Population, other: Population) -> bool:
    return np.array_equal(one.source_vertices, other.source_vertices)


def test_the_packaged_people_are_enough_for_their_seed(women, committed):
    found = solved_population(women, count=3, seed=1)
    assert same(found, subjects(committed, slice(0, 3)))


def test_subjects_of_another_seed_come_from_a_folder_that_keeps_them(women, committed, tmp_path):
    others = subjects(committed, slice(3, 6))
    keep(tmp_path, 2, others)
    assert same(solved_population(women, count=3, seed=2, folder=tmp_path), others)


@pytest.mark.parametrize(("count", "anew"), [(2, False), (1, True)])
def test_else_they_are_solved_and_the_folder_keeps_them(women, committed, tmp_path, count, anew):
    stale = subjects(committed, slice(5, 6))
    keep(tmp_path, 2, stale)  # too few, or not to be read
    found = solved_population(women, count=count, seed=2, folder=tmp_path, anew=anew)
    assert len(found.source_vertices) == count
    assert not same(subjects(found, slice(0, 1)), stale)
    again = load_population(population_path(tmp_path, "female", 2), women.space, count=count)
    np.testing.assert_allclose(again.source_vertices, found.source_vertices, atol=1e-4)


def test_the_committed_held_out_subjects_give_the_figures_that_headers_claim(materials):
    for gender in GENDERS:
        model = load_body_model(packaged_model_path(gender))
        claimed = model.header["held_out_errors"]
        assert isinstance(claimed, Mapping)
        mine = materials[gender]
        population = solved_population(mine, count=int(str(claimed["subjects"])), seed=1)
        bodies = rigged_bodies(mine.mesh, population.source_vertices)
        shape = shape_error(model, bodies.rest)
        joints = joint_errors_mm(model.joint_regressor, bodies.rest, bodies.joints)
        found = {
            "shape_mm": shape.by_vertex,
            "shape_by_area_mm": shape.by_area,
            "joints_mm": joints.mean(),
            "worst_joint_mm": joints.max(),
        }
        for name, value in found.items():
            assert value == pytest.approx(claimed[name], rel=0, abs=TOLERANCE_MM), (gender, name)
        # Whitened on the training subjects, coefficients of others are nearly white.
        coefficients = shape_coefficients(model, bodies.rest)
        np.testing.assert_allclose(coefficients.std(axis=0), 1.0, atol=0.25)
