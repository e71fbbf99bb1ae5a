"""A field of a name that there is not: which one was meant, as far as its name tells."""

import json

import pytest

from api_schemas.fit import FitRequest
from service.submissions.refusal import RefusedError
from service.submissions.validation import parsed


@pytest.mark.parametrize(
    ("name", "remedy"),
    [
        ("height", "Remove it, or correct its name: height_m?"),
        ("height_cm", "Remove it, or correct its name: height_m?"),
        ("weight", "Remove it, or correct its name: weight_kg?"),
        ("view", "Remove it, or correct its name: views?"),
        ("colour", "Remove it, or correct its name."),
    ],
)
def test_an_unknown_field_is_told_by_what_it_may_have_been_meant_for(name: str, remedy: str):
    text = json.dumps({"gender": "male", name: 1}).encode()
    with pytest.raises(RefusedError) as refusal:
        parsed(FitRequest, text, whole="request", called="the part 'request'")
    (error,) = refusal.value.problem.errors
    assert (error.field, error.code, error.remedy) == (name, "unknown-field", remedy)
