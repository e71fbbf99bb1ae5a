"""Where subjects come from: the committed population, the cache, or solving."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training import build
from fitter.training.evaluation import joint_distances, shape_coefficients, shape_error
from fitter.training.makehuman import makehuman_folder
from fitter.training.population import packaged_population_path
from tests.unit.training.makehuman_data import needs_makehuman

TOLERANCE_MM = 1e-3


@dataclass
class Kept:
    """Files of so many subjects each, and how many were solved."""

    sizes: Mapping[Path, int]
    solved: list[int] = field(default_factory=list)
    saved: list[Path] = field(default_factory=list)

    def load(self, path: Path, space: object, *, count: int) -> SimpleNamespace:
        del space
        return people(min(count, self.sizes[path]), path)

    def solve(self, workshop: object, count: int, seed: int, *, processes: int) -> SimpleNamespace:
        del workshop, seed, processes
        self.solved.append(count)
        return people(count, None)

    def save(self, path: Path, population: object) -> None:
        del population
        self.saved.append(path)


def people(count: int, source: Path | None) -> SimpleNamespace:
    return SimpleNamespace(source_vertices=np.zeros((count, 1, 3)), source=source)


@pytest.fixture
def kept(monkeypatch, tmp_path) -> Kept:
    cached = tmp_path / "population_female_1.npz"
    cached.touch()
    found = Kept({packaged_population_path("female"): 1300, cached: 2000})
    monkeypatch.setattr(build, "load_population", found.load)
    monkeypatch.setattr(build, "solve_population", found.solve)
    monkeypatch.setattr(build, "save_population", found.save)
    monkeypatch.setattr(build, "prepare", lambda space, landmarks: None)
    return found


def population(cache: Path | None, *, count: int = 200, seed: int = 1, anew: bool = False):
    materials = SimpleNamespace(spaces={"female": None}, landmarks=None)
    found = build.solved_population(
        cast("build.Materials", materials),
        "female",
        count=count,
        seed=seed,
        cache=cache,
        anew=anew,
    )
    return cast("SimpleNamespace", found)


def test_the_committed_population_is_enough_for_its_seed(kept, tmp_path):
    found = population(tmp_path, count=1300)
    assert found.source == packaged_population_path("female")
    assert kept.solved == []


def test_more_subjects_than_are_committed_come_from_the_cache(kept, tmp_path):
    assert population(tmp_path, count=1500).source == tmp_path / "population_female_1.npz"
    assert kept.solved == []


@pytest.mark.parametrize("wanted", [{"seed": 2}, {"count": 2500}, {"anew": True}])
def test_else_they_are_solved_and_the_cache_keeps_them(kept, tmp_path, wanted):
    found = population(tmp_path, **wanted)
    assert found.source is None
    assert kept.solved == [wanted.get("count", 200)]
    assert kept.saved == [tmp_path / f"population_female_{wanted.get('seed', 1)}.npz"]


def test_without_a_cache_nothing_is_written(kept):
    population(None, seed=3)
    assert kept.solved == [200]
    assert kept.saved == []


@pytest.mark.slow
@needs_makehuman
def test_the_committed_held_out_subjects_give_the_figures_that_headers_claim(monkeypatch):
    def refuse(*arguments: object, **options: object) -> None:
        message = "subjects must not be solved"
        raise AssertionError(message)

    monkeypatch.setattr(build, "solve_population", refuse)
    materials = build.read_materials(makehuman_folder())
    for gender in build.GENDERS:
        model = load_body_model(packaged_model_path(gender))
        bodies = build.held_out_bodies(materials, model, cache=None)
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
