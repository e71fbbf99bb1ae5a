from dataclasses import replace

import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.anthropometry import measurement_values, measuring_body
from fitter.training.assemble import assemble_body_model, height_attribute
from fitter.training.build import Plan, provenance, subjects, write_model
from fitter.training.people.population import Population
from fitter.training.report.header_figures import measured_bodies, model_statistics
from fitter.training.report.sections import Reported, disagreements, summary_lines
from tests.unit.training.synthetic_population import landmarks, part_weights, population, surface

PLAN = Plan(subjects=4, held_out=2, examples=0, seed=7)


def surveyed(count: int) -> Population:
    wanted = np.tile([1.70, 65.0], (count, 1)) + np.arange(count)[:, None] * [0.05, 5.0]
    return Population(
        ages=np.full(count, 30.0),
        ancestries=np.full((count, 3), 1.0 / 3.0),
        faces=np.zeros((count, 2)),
        source_vertices=np.arange(count * 6, dtype=np.float32).reshape(count, 2, 3),
        parameters=np.zeros((count, 1)),
        parameter_names=("height",),
        wanted=wanted,
        reached=wanted + [0.002, -1.5],
        measurement_names=("stature", "weightkg"),
    )


FIGURES = {
    "subjects": 2,
    "shape_mm": 2.9,
    "height_change_at_3_deviations_mm": 0.1,
    "height_correlation": 0.999,
    "posed_mm": 4.6,
}


@pytest.fixture(scope="module")
def trained():
    return assemble_body_model(
        population(80, 1),
        surface(),
        part_weights(),
        landmarks(),
        header=provenance("female", surveyed(4), PLAN),
        example_count=0,
        rng=np.random.default_rng(0),
    )


def reported(trained, kept: dict[str, float] | None = None) -> Reported:
    header = dict(trained.model.header) | ({} if kept is None else {"held_out_errors": kept})
    model = replace(trained.model, header=header)
    return Reported(model=model, held_out=FIGURES, file_bytes=6_000_000)


@pytest.mark.parametrize("name", ["shape_mm", "height_correlation"])
def test_a_figure_that_differs_from_the_headers_is_named(trained, name):
    found = reported(trained, FIGURES | {name: FIGURES[name] + 0.01})
    assert disagreements(found) == (name,)
    assert f"DIFFERENT: {name}" in summary_lines(found)[-1]


def test_whole_bodies_measure_as_the_shapes_they_are():
    model = load_body_model(packaged_model_path("female"))
    shapes = np.random.default_rng(2).normal(size=(3, 20))
    rest = np.stack([rest_vertices(model, shape) for shape in shapes])
    body = measuring_body(model, ScapeEvaluator(model))
    expected = np.stack([measurement_values(body, shape) for shape in shapes])
    np.testing.assert_allclose(measured_bodies(model, rest), expected, atol=2e-3)


def test_the_header_gives_height_in_the_models_own_definition(trained):
    height = height_attribute(trained.model)
    found = model_statistics(trained)["height_m"]
    np.testing.assert_allclose(found["mean"], height(np.zeros(20)))
    np.testing.assert_allclose(
        height(np.eye(20)[0] * 2.0), found["mean"] + 2.0 * found["sd"], rtol=1e-6
    )


def test_held_out_and_training_subjects_are_told_apart_by_number():
    whole = surveyed(6)
    held_out, training = subjects(whole, slice(0, 2)), subjects(whole, slice(2, 6))
    assert len(held_out.wanted) == 2
    assert not set(held_out.wanted[:, 0]) & set(training.wanted[:, 0])
    np.testing.assert_array_equal(training.source_vertices, whole.source_vertices[2:])


def test_a_written_model_leaves_no_unfinished_file(trained, tmp_path):
    model = trained.model
    header = dict(model.header) | model_statistics(trained)
    header["held_out_errors"] = FIGURES
    loaded = write_model(tmp_path / "data" / "female.npz", replace(model, header=header))
    assert [path.name for path in (tmp_path / "data").iterdir()] == ["female.npz"]
    again = load_body_model(tmp_path / "data" / "female.npz")
    assert again.header == loaded.header
    assert again.header["held_out_errors"]["shape_mm"] == 2.9
