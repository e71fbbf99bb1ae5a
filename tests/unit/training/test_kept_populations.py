"""Where subjects come from: the committed population, the cache, or solving."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.build import (
    GENDERS,
    Materials,
    held_out_bodies,
    read_materials,
    solved_population,
    subjects,
)
from fitter.training.makehuman.meshes import makehuman_folder
from fitter.training.people.population import (
    Population,
    load_population,
    packaged_population_path,
    save_population,
)
from fitter.training.report.evaluation import joint_distances, shape_coefficients, shape_error
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = [pytest.mark.slow, needs_makehuman]

TOLERANCE_MM = 1e-3


@pytest.fixture(scope="module")
def materials() -> Materials:
    return read_materials(makehuman_folder())


@pytest.fixture(scope="module")
def committed(materials: Materials) -> Population:
    """A few of the committed women."""
    return load_population(packaged_population_path("female"), materials.spaces["female"], count=6)


def kept(cache: Path, seed: int, population: Population) -> None:
    save_population(cache / f"population_female_{seed}.npz", population)


def read(materials: Materials, cache: Path, seed: int, *, count: int) -> Population:
    path = cache / f"population_female_{seed}.npz"
    return load_population(path, materials.spaces["female"], count=count)


def same(one: Population, other: Population) -> bool:
    return np.array_equal(one.source_vertices, other.source_vertices)


def test_the_committed_population_is_enough_for_its_seed(materials, committed, tmp_path):
    kept(tmp_path, 1, subjects(committed, slice(3, 6)))
    found = solved_population(materials, "female", count=3, seed=1, cache=tmp_path)
    assert same(found, subjects(committed, slice(0, 3)))


def test_subjects_of_another_seed_come_from_the_cache(materials, committed, tmp_path):
    others = subjects(committed, slice(3, 6))
    kept(tmp_path, 2, others)
    assert same(solved_population(materials, "female", count=3, seed=2, cache=tmp_path), others)


@pytest.mark.parametrize(("seed", "anew"), [(2, False), (1, True)])
def test_else_they_are_solved_and_the_cache_keeps_them(materials, committed, tmp_path, seed, anew):
    stale = subjects(committed, slice(5, 6))
    kept(tmp_path, seed, stale)  # too few, or not to be read
    count = 1 if anew else 2
    found = solved_population(
        materials, "female", count=count, seed=seed, cache=tmp_path, anew=anew
    )
    assert len(found.source_vertices) == count
    assert not same(subjects(found, slice(0, 1)), stale)
    np.testing.assert_allclose(
        read(materials, tmp_path, seed, count=count).source_vertices,
        found.source_vertices,
        atol=1e-4,
    )


def test_the_committed_held_out_subjects_give_the_figures_that_headers_claim(materials):
    for gender in GENDERS:
        model = load_body_model(packaged_model_path(gender))
        bodies = held_out_bodies(materials, model, cache=None)
        claimed = model.header["held_out_errors"]
        assert isinstance(claimed, Mapping)
        assert len(bodies.rest) == claimed["subjects"]
        shape, joints = shape_error(model, bodies.rest), joint_distances(model, bodies)
        found = {
            "shape_mm": shape.by_vertex,
            "shape_by_area_mm": shape.by_area,
            "joints_mm": np.mean(list(joints.values())),
            "worst_joint_mm": max(joints.values()),
        }
        for name, value in found.items():
            assert value == pytest.approx(claimed[name], rel=0, abs=TOLERANCE_MM), (gender, name)
        # Whitened on the training subjects, coefficients of others are nearly white.
        coefficients = shape_coefficients(model, bodies.rest)
        np.testing.assert_allclose(coefficients.std(axis=0), 1.0, atol=0.25)
