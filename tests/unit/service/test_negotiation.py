"""Accept headers, as RFC 9110 has them and as they come."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.api.files import preferred

OFFERED = ("model/gltf-binary", "model/obj", "text/csv")


@pytest.mark.parametrize(
    ("accept", "chosen"),
    [
        (None, "model/gltf-binary"),
        ("", "model/gltf-binary"),
        ("*/*", "model/gltf-binary"),
        ("model/*", "model/gltf-binary"),
        ("text/*", "text/csv"),
        ("text/csv; charset=utf-8", "text/csv"),
        ("model/obj", "model/obj"),
        ("model/obj;q=0.2, text/csv;q=0.3", "text/csv"),
        ("text/csv, model/obj", "text/csv"),
        ("model/obj, text/csv", "model/obj"),
        ("*/*, model/obj", "model/obj"),
        ("model/*;q=0.9, model/obj;q=0.1", "model/gltf-binary"),
        ("model/*, model/gltf-binary;q=0", "model/obj"),
        ("*/*;q=0.1, model/*;q=0", "text/csv"),
        ("model/obj;q=2, text/csv;q=0.1", "model/obj"),
        ("audio/*, model/gltf-binary;Q=1.000", "model/gltf-binary"),
        ("model/fbx", None),
        ("*/*;q=0", None),
        ("model/obj;q=0.000", None),
    ],
)
def test_the_type_that_is_wanted_most_is_chosen(accept, chosen):
    assert preferred(accept, OFFERED) == chosen


@given(st.text(alphabet="*/,;= q.0123model-objcsvtx\t\x00é", max_size=60))
def test_whatever_comes_one_of_what_there_is_or_nothing_is_chosen(accept):
    assert preferred(accept, OFFERED) in (*OFFERED, None)
