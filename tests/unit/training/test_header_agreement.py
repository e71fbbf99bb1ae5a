from dataclasses import replace

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.report.evaluation import VertexError
from fitter.training.report.header_agreement import agreement_lines, disagreements
from fitter.training.report.held_out_errors import HeldOutErrors, header_entry
from fitter.training.report.reported import Reported

SMALL = VertexError(by_vertex=1.0, by_area=2.0)
ERRORS = HeldOutErrors(
    subjects=2,
    shape=SMALL,
    height_change_at_3_deviations=0.1,
    extent_change_at_3_deviations=0.2,
    height_per_deviation=60.0,
    height_correlation=0.999,
    posed=SMALL,
    posed_rigid_parts_only=SMALL,
    shaped_and_posed=SMALL,
    joints={"pelvis": 2.0, "left_hand": 4.0},
)


def reported(entry: dict[str, float] | None) -> Reported:
    model = load_body_model(packaged_model_path("female"))
    header = {name: value for name, value in model.header.items() if name != "held_out_errors"}
    if entry is not None:
        header["held_out_errors"] = entry
    nobody = RegisteredBodies(
        rest=np.zeros((0, 1, 3)),
        joints=np.zeros((0, 1, 3)),
        posed=lambda subject, pose: np.zeros((1, 3)),
    )
    model = replace(model, header=header)
    return Reported(model=model, bodies=nobody, errors=ERRORS, file_bytes=1)


def test_figures_that_repeat_are_said_in_a_line():
    lines = agreement_lines(reported(dict(header_entry(ERRORS))))
    assert len(lines) == 1
    assert "the same" in lines[0]


@pytest.mark.parametrize("name", ["shape_mm", "worst_joint_mm", "height_correlation"])
def test_a_figure_that_differs_is_named_with_both_values(name: str):
    entry = dict(header_entry(ERRORS))
    entry[name] += 0.01
    found = reported(entry)
    assert set(disagreements(found)) == {name}
    assert "DIFFERENT" in agreement_lines(found)[0]


def test_a_header_that_lacks_figures_does_not_agree():
    entry = dict(header_entry(ERRORS))
    del entry["posed_mm"]
    assert set(disagreements(reported(entry))) == {"posed_mm"}
    assert set(disagreements(reported(None))) == set(header_entry(ERRORS))
