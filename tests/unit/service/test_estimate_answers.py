"""The estimator's real answers, with the measurements a request knows."""

import pytest

from api_schemas.bodies import BodyRequest
from api_schemas.known import UncertainMeasurement
from api_schemas.requests import Gender
from service.estimates.answers import body
from service.estimates.messages import BodyTask
from service.worker.pipeline_port import UnusableInputError


def answer(**known: object):
    request = BodyRequest.model_validate({"gender": Gender.FEMALE} | known)
    return body(BodyTask(request=request, with_glb=False), None).estimate


def test_height_weight_and_measurements_are_known_alike():
    found = {
        each.name: each
        for each in answer(
            height_m=1.68,
            weight_kg=64.5,
            measurements={
                "waist_girth_navel": UncertainMeasurement(value=78.0, standard_error=1.5)
            },
        ).measurements
    }
    assert {name for name, each in found.items() if each.given} == {
        "stature",
        "weight",
        "waist_girth_navel",
    }
    assert found["stature"].value == pytest.approx(168.0, abs=0.01)
    assert found["weight"].value == pytest.approx(64.5, abs=0.01)
    assert 0.5 < found["waist_girth_navel"].standard_error < 1.5


@pytest.mark.parametrize(
    ("known", "field", "code"),
    [
        ({"height_m": 1.68, "weight_kg": 700.0}, "weight_kg", "out-of-range"),
        ({"measurements": {"weight": 700.0}}, "measurements.weight", "out-of-range"),
        ({"height_m": 2.3, "weight_kg": 64.0}, "height_m", "out-of-range"),
        ({"measurements": {"bust": 90.0}}, "measurements.bust", "unknown-value"),
    ],
)
def test_what_nobody_is_is_refused_where_it_was_said(known, field, code):
    with pytest.raises(UnusableInputError) as caught:
        answer(**known)
    assert (caught.value.error.field, caught.value.error.code) == (field, code)
    assert caught.value.error.remedy
