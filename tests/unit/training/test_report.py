import re
from dataclasses import replace

import numpy as np
import pytest

from fitter.body.storage import load_body_model
from fitter.training.assemble import assemble_body_model, height_attribute
from fitter.training.build import subjects, write_model
from fitter.training.people.population import Population
from fitter.training.plan import Plan
from fitter.training.report.evaluation import VertexError
from fitter.training.report.held_out_errors import HeldOutErrors, header_entry
from fitter.training.report.provenance import (
    model_statistics,
    provenance,
    residual_lines,
    residuals,
)
from fitter.training.report.reported import Reported
from fitter.training.report.summary_figures import goals, summary_lines
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
        lower=np.zeros(1),
        upper=np.ones(1),
        wanted=wanted,
        reached=wanted + [0.002, -1.5],
        measurement_names=("stature", "weightkg"),
        deviation=np.ones(2),
    )


def errors(shape_mm: float) -> HeldOutErrors:
    small = VertexError(by_vertex=1.0, by_area=1.0)
    return HeldOutErrors(
        subjects=2,
        shape=VertexError(by_vertex=shape_mm, by_area=2.0),
        height_change_at_3_deviations=0.1,
        extent_change_at_3_deviations=0.2,
        height_per_deviation=60.0,
        height_correlation=0.999,
        posed=small,
        posed_rigid_parts_only=small,
        shaped_and_posed=small,
        joints={"pelvis": 2.0, "left_hand": 4.0},
    )


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


def reported(trained, shape_mm=3.0) -> Reported:
    return Reported(
        model=trained.model,
        bodies=population(2, 9),
        errors=errors(shape_mm),
        file_bytes=6_000_000,
    )


@pytest.mark.parametrize(("shape_mm", "verdict"), [(2.9, "ok"), (3.1, "MISSED")])
def test_the_report_says_which_goals_are_missed(trained, shape_mm, verdict):
    lines = summary_lines(reported(trained, shape_mm))
    line = next(line for line in lines if "mean vertex error" in line)
    assert re.search(rf"{shape_mm:.3f} mm .*{verdict}$", line)


def test_the_report_names_the_worst_joint(trained):
    text = "\n".join(summary_lines(reported(trained)))
    assert re.search(r"joint centres, mean distance +3\.000 mm", text)
    assert re.search(r"joint centres, worst: left_hand +4\.000 mm", text)


def test_every_goal_of_the_model_is_judged(trained):
    names = " ".join(goal.name for goal in goals(reported(trained)))
    for word in ("vertex error", "height change", "posed error", "one evaluation"):
        assert word in names


def test_the_report_repeats_the_populations_residuals(trained):
    text = "\n".join(residual_lines(reported(trained)))
    assert re.search(r"stature +2\.0 mm", text)
    assert re.search(r"weightkg +1\.50 kg", text)


def test_the_header_names_sources_counts_and_ranges():
    header = provenance("female", surveyed(5), PLAN)
    assert header["seed"] == 7
    assert (header["training_subjects"], header["held_out_subjects"]) == (4, 2)
    assert header["stature_m"] == {
        "lowest": 1.7,
        "median": 1.8,
        "highest": 1.9,
        "mean": 1.8,
        "sd": 0.071,
    }
    assert any("MakeHuman" in str(source) for source in header["sources"])


def test_residuals_are_mean_absolute_distances_in_their_units():
    assert residuals(surveyed(3)) == {"stature": "2.0 mm", "weightkg": "1.50 kg"}


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
    header["held_out_errors"] = header_entry(errors(3.0))
    loaded = write_model(tmp_path / "data" / "female.npz", replace(model, header=header))
    assert [path.name for path in (tmp_path / "data").iterdir()] == ["female.npz"]
    again = load_body_model(tmp_path / "data" / "female.npz")
    assert again.header == loaded.header
    assert again.header["held_out_errors"]["shape_mm"] == 3.0
