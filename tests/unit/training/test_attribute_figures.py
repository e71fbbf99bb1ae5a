import re

import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.report.attribute_figures import (
    MeasuredAttribute,
    attribute_figures,
    attribute_lines,
)
from fitter.training.report.comparison_figures import comparison_lines
from fitter.training.report.evaluation import VertexError
from fitter.training.report.held_out_errors import HeldOutErrors
from fitter.training.report.reported import Reported

SHAPES = np.random.default_rng(4).normal(size=(30, 20))


@pytest.fixture(scope="module")
def reported():
    """People who are bodies of the model themselves, so that correlations are perfect."""
    model = load_body_model(packaged_model_path("female"))
    evaluator = ScapeEvaluator(model)

    def posed(subject, pose):
        parameters = BodyParameters(pose=pose, translation=np.zeros(3), shape=SHAPES[subject])
        return evaluator.body_frame_vertices(parameters)

    bodies = RegisteredBodies(
        rest=np.stack([rest_vertices(model, shape) for shape in SHAPES]),
        joints=np.zeros((len(SHAPES), 17, 3)),
        posed=posed,
    )
    small = VertexError(by_vertex=1.0, by_area=1.0)
    errors = HeldOutErrors(
        subjects=len(SHAPES),
        shape=small,
        height_change_at_3_deviations=0.1,
        extent_change_at_3_deviations=0.2,
        height_per_deviation=60.0,
        height_correlation=0.999,
        posed=small,
        posed_rigid_parts_only=small,
        shaped_and_posed=small,
        joints={"pelvis": 2.0},
    )
    return Reported(model=model, bodies=bodies, errors=errors, file_bytes=1)


def test_a_linear_attribute_moves_on_its_own_axis_only(reported):
    gradient = np.random.default_rng(1).normal(size=20)
    figures = attribute_figures(
        reported.model,
        MeasuredAttribute(
            name="planted",
            unit="mm",
            of_model=lambda _: lambda shape: float(gradient @ shape),
            of_people=SHAPES @ gradient,
        ),
        SHAPES,
    )
    assert figures.per_deviation == pytest.approx(np.linalg.norm(gradient))
    assert figures.largest_change < 1e-6
    assert figures.correlation == pytest.approx(1.0)
    assert figures.blanz_vetter_change > 0.1


def test_the_table_holds_height_weight_a_girth_and_two_lengths_over_the_skin(reported):
    lines = attribute_lines(reported)
    rows = {
        name: [float(cell) for cell in re.findall(r"-?\d+\.\d+", line)]
        for name in ("stature", "weight", "waist_girth_navel", "right_wrist", "crotch")
        for line in lines
        if re.match(rf"    (over the skin, \w+ to )?{name} ", line)
    }
    assert len(rows) == 5
    for per_deviation, largest, mean, earlier, correlation in rows.values():
        assert mean <= largest < 0.2 * per_deviation
        assert largest < earlier
        assert correlation > 0.98
    assert rows["stature"][1] < 0.01


def test_earlier_methods_are_explained_beside_their_figures(reported):
    text = "\n".join(comparison_lines(reported))
    assert re.search(r"Blanz and Vetter, axes orthogonal as shapes +\d+\.\d+ mm", text)
    assert re.search(r"this rotation +0\.100 mm", text)
    assert "leaves only the attributes to vary" in " ".join(text.split())
