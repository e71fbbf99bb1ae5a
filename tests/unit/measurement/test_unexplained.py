import json
from dataclasses import replace

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.measurement.anthropometry import UNEXPLAINED_KEY, UNEXPLAINED_PATH, unexplained
from fitter.measurement.definition_file import load_definitions

NAMES = [definition.about.name for definition in load_definitions()]


@pytest.mark.parametrize("gender", ["female", "male"])
def test_every_measurement_of_the_packaged_models_leaves_something_unexplained(gender):
    found = unexplained(load_body_model(packaged_model_path(gender)), NAMES)
    assert found.shape == (len(NAMES),)
    assert (found > 0.1).all()
    assert (found < 2.5).all()


@pytest.mark.parametrize("gender", ["female", "male"])
def test_what_was_found_since_training_agrees_with_what_the_model_says(gender):
    model = load_body_model(packaged_model_path(gender))
    said = model.header[UNEXPLAINED_KEY]
    since = json.loads(UNEXPLAINED_PATH.read_text())[model.checksum]
    for name, value in said.items():
        assert since[name] == pytest.approx(value, abs=0.005), name


def test_the_models_own_word_counts_before_what_was_found_since():
    model = load_body_model(packaged_model_path("female"))
    other = replace(model, header=model.header | {UNEXPLAINED_KEY: {"hip_girth": 7.0}})
    hip, waist = unexplained(other, ["hip_girth", "waist_girth_navel"])
    assert hip == 7.0
    assert 0.0 < waist < 2.0


def test_nothing_is_said_of_a_model_that_nobody_knows():
    model = load_body_model(packaged_model_path("female"))
    other = replace(model, header={"checksum": "unknown"})
    assert np.array_equal(unexplained(other, NAMES), np.zeros(len(NAMES)))
