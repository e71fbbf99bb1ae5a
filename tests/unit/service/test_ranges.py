import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.api.files import ByteRange, parse_range


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        ("bytes=0-0", ByteRange(0, 0)),
        ("bytes=0-", ByteRange(0, 99)),
        ("bytes=90-200", ByteRange(90, 99)),
        ("bytes=-10", ByteRange(90, 99)),
        ("bytes=-1000", ByteRange(0, 99)),
        ("bytes=5-4", None),
        ("bytes=-", None),
        ("bytes=0-1,5-6", None),
        ("lines=0-1", None),
        ("nonsense", None),
    ],
)
def test_a_range_is_read_as_rfc_9110_says(header, expected):
    assert parse_range(header, 100) == expected


@pytest.mark.parametrize("header", ["bytes=100-", "bytes=100-200", "bytes=-0"])
def test_a_range_outside_the_file_is_an_error(header):
    with pytest.raises(ValueError, match="bytes"):
        parse_range(header, 100)


@given(st.text(max_size=30), st.integers(1, 1000))
def test_whatever_is_sent_a_range_lies_within_the_file(header, size):
    try:
        part = parse_range("bytes=" + header, size)
    except ValueError:
        return
    assert part is None or 0 <= part.first <= part.last < size
