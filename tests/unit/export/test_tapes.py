import json

import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.export import tapes_json
from fitter.measurement.anthropometry import measuring_body, tape_lines
from fitter.measurement.definitions import Height, Length
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.results import result_of
from tests.unit.measurement.made_up import about

DEFINITIONS = (
    Height(about=about("stature"), point=("crown",)),
    Length(about=about("length"), path=(("joint:bottom",), ("joint:top",))),
)


def test_lines_lie_in_the_frame_of_the_canonical_body():
    model = bar_model()
    result = result_of(model)
    measuring = measuring_body(model, ScapeEvaluator(model), DEFINITIONS)
    document = json.loads(tapes_json(result, measuring))
    lowest = result.canonical_vertices[:, 1].min()
    for name, line in tape_lines(measuring, result.person.body.shape).items():
        expected = line - [0.0, lowest, 0.0]
        assert np.array(document["lines"][name]) == pytest.approx(expected, abs=6e-5)
