"""The samples of failures are what this service says, of every type it answers with."""

import pytest

from api_schemas.fit import FitRequest
from api_schemas.problems import PROBLEM_TYPES
from service.api.problem_samples import PROBLEM_SAMPLES
from service.submissions.refusal import RefusedError
from service.submissions.validation import parsed


def test_there_is_one_of_every_type():
    assert list(PROBLEM_SAMPLES) == sorted(PROBLEM_SAMPLES, key=list(PROBLEM_TYPES).index)
    assert set(PROBLEM_SAMPLES) == set(PROBLEM_TYPES)


@pytest.mark.parametrize("slug", PROBLEM_SAMPLES)
def test_a_sample_says_what_happened_and_not_what_may(slug: str):
    sample = PROBLEM_SAMPLES[slug]
    assert sample.detail != PROBLEM_TYPES[slug].description
    assert sample.status == PROBLEM_TYPES[slug].status


@pytest.mark.parametrize(
    ("slug", "sent"),
    [
        ("malformed-request", b'{"gender": "male" "x": 1}'),
        ("invalid-request", b'{"height_m": 2.5, "points": {}}'),
    ],
)
def test_refused_requests_are_told_in_these_words(slug: str, sent: bytes):
    with pytest.raises(RefusedError) as refused:
        parsed(FitRequest, sent, whole="request", called="the request")
    told, sample = refused.value.problem, PROBLEM_SAMPLES[slug]
    assert (told.detail, told.code, told.remedy) == (sample.detail, sample.code, sample.remedy)
