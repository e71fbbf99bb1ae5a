"""What a person may be called."""

import json

import pytest

from api_schemas.fit import FitRequest
from api_schemas.labels import LONGEST
from service.submissions.refusal import RefusedError, parsed


def labelled(label: object) -> FitRequest:
    text = json.dumps({"gender": "male", "label": label}).encode()
    return parsed(FitRequest, text, whole="request", called="the part 'request'")


@pytest.mark.parametrize(
    "label",
    [
        "A",
        "customer-4711",
        "O'Brien, Zoë",
        "山田　太郎",
        "علی‌رضا",
        "👩‍🔬",
        "葛\U000e0100城",
        " spaced ",
        "x" * LONGEST,
    ],
)
def test_any_readable_text_is_a_label_and_stays_as_it_was_sent(label):
    assert labelled(label).label == label


def test_a_label_may_be_left_out():
    assert labelled(None).label is None


@pytest.mark.parametrize(
    ("label", "code"),
    [
        ("", "wrong-length"),
        ("x" * (LONGEST + 1), "wrong-length"),
        ("   ", "unreadable-label"),
        ("\u00a0\u3000", "unreadable-label"),
        ("two\nlines", "unreadable-label"),
        ("ends\n", "unreadable-label"),
        ("nul\0", "unreadable-label"),
        ("\u202egnirts", "unreadable-label"),
        ("\u200b", "unreadable-label"),
        ("\u3164", "unreadable-label"),
        ("\u200d", "unreadable-label"),
        ("soft\u00adhyphen", "unreadable-label"),
        ("tag\U000e0001", "unreadable-label"),
        (4711, "wrong-kind"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name(label, code):
    with pytest.raises(RefusedError) as caught:
        labelled(label)
    assert (caught.value.problem.field, caught.value.problem.code) == ("label", code)
    assert caught.value.problem.remedy
