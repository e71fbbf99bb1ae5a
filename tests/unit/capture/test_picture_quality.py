"""Exposure and sharpness of pictures."""

import cv2
import numpy as np
import pytest

from fitter.capture.picture_quality import (
    BLOCKING_PX,
    DARKEST,
    HARMFUL_PX,
    blur_of_edges,
    bright_luminance,
    brightness,
    burnt_share,
    darkness,
    sharpness,
)
from fitter.observation.pixels import display_from_linear
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import by_points_alone, capture, is_unchecked, of_nobody


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


def steps(contrast: float = 0.5) -> np.ndarray:
    """(h, w) slabs far apart, at a slant."""
    rows, columns = np.indices((300, 300))
    return (0.2 + contrast * ((rows + 0.3 * columns) % 100 > 50)).astype(np.float32)


@pytest.mark.parametrize("deviation_px", [1.0, 1.5, 2.0, 3.0, 4.0])
def test_the_blur_of_an_edge_is_found_whatever_its_contrast(deviation_px):
    """Pixels and the slope's own differences are a blur of 0.6."""
    for contrast in (0.05, 0.5):
        blurred = cv2.GaussianBlur(steps(contrast), (0, 0), deviation_px)
        found = blur_of_edges(blurred, np.ones(blurred.shape, bool))
        assert found == pytest.approx(np.hypot(deviation_px, 0.6), rel=0.1)


@pytest.mark.parametrize("shape", [(1, 11), (11, 1)], ids=["sideways", "up and down"])
def test_a_motion_blurs_the_edges_across_it(shape):
    """A box of 11 pixels has a standard deviation of 3.2; its ramps look softer yet."""
    grid = np.maximum(steps(), steps().T)
    found = blur_of_edges(
        cv2.filter2D(grid, -1, np.full(shape, 1.0 / 11.0, np.float32)),
        np.ones(grid.shape, bool),
    )
    assert found is not None
    assert 3.0 < found < 6.0


def test_only_edges_of_the_region_count():
    half = np.zeros((300, 300), bool)
    half[:, :140] = True
    mixed = np.where(half, steps(), cv2.GaussianBlur(steps(), (0, 0), 4.0))
    sharp, soft = blur_of_edges(mixed, half), blur_of_edges(mixed, ~half)
    assert sharp is not None
    assert soft is not None
    assert sharp < 1.2 < 3.0 < soft


def test_a_plain_surface_has_no_edges():
    assert blur_of_edges(np.full((50, 50), 0.5, np.float32), np.ones((50, 50), bool)) is None
    assert blur_of_edges(steps(), np.zeros((300, 300), bool)) is None


@pytest.mark.parametrize(
    ("deviation_px", "severity"),
    [(1.0, None), (1.1 * HARMFUL_PX, Severity.HARMS), (2.0 * BLOCKING_PX, Severity.BLOCKS)],
)
def test_a_blurred_person_is_told_with_the_blur_on_their_body(deviation_px, severity):
    whole = capture()
    found = sharpness(capture(picture=cv2.GaussianBlur(whole.picture, (0, 0), deviation_px)))
    if severity is None:
        assert found is None
        return
    assert found is not None
    assert (found.code, found.severity) == (Code.BLURRED, severity)
    assert "mm on the body" in found.reason


def test_of_a_picture_of_nobody_all_edges_are_looked_at():
    blurred = cv2.GaussianBlur(capture().picture, (0, 0), 3.0)
    found = sharpness(of_nobody(picture=blurred))
    assert found is not None
    assert "on the body" not in found.reason
    plain = np.full_like(blurred, 90)
    assert is_unchecked(sharpness(of_nobody(picture=plain)))
