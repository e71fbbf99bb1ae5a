"""Too dark and burnt out."""

import numpy as np
import pytest

from fitter.capture.picture_quality import (
    DARKEST,
    bright_luminance,
    brightness,
    burnt_share,
    darkness,
)
from fitter.observation.pixels import display_from_linear
from fitter.vocabulary.remarks import Code
from tests.unit.capture.made_up import by_points_alone, capture


def painted(value: int, *, mask: np.ndarray | None = None) -> np.ndarray:
    """(h, w, 3) the person in one grey before a wall as light as a clear sky."""
    mask = capture().region if mask is None else mask
    return np.where(mask[..., None], value, 240).astype(np.uint8).repeat(3, axis=2)


def test_luminance_is_linear_and_of_the_brighter_parts():
    ramp = np.rint(255.0 * display_from_linear(np.linspace(0.0, 1.0, 1001))).astype(np.uint8)
    assert bright_luminance(np.stack([ramp] * 3, axis=1)) == pytest.approx(0.9, abs=0.01)


def test_a_dark_person_before_a_bright_wall_is_too_dark_and_before_none():
    least = int(255.0 * display_from_linear(np.array(DARKEST)))
    for make in (capture, by_points_alone):
        region = make().region
        found = darkness(make(picture=painted(least - 3, mask=region)))
        assert found is not None
        assert (found.code, "2.5 %" in found.reason) == (Code.TOO_DARK, True)
        assert darkness(make(picture=painted(least + 3, mask=region))) is None


def test_a_person_is_burnt_out_where_much_of_them_may_be_cut_off():
    assert brightness(capture(picture=painted(252))) is None
    found = brightness(capture(picture=painted(255)))
    assert found is not None
    assert (found.code, found.reason[:5]) == (Code.TOO_BRIGHT, "100 %")


def test_without_an_outline_the_person_is_what_lies_along_the_bones():
    """Most of it is the person, and most of the person's trunk is in it."""
    region, mask = by_points_alone().region, capture().region
    assert np.mean(mask[region]) > 0.85
    assert region.sum() > 0.5 * mask.sum()


def test_one_channel_is_enough_to_be_burnt():
    pixels = np.array([[255, 10, 10], [252, 252, 252]], np.uint8)
    assert burnt_share(pixels) == 0.5
