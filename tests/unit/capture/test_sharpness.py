"""Blur, of edges whose blur is known."""

import cv2
import numpy as np
import pytest

from fitter.capture.picture_quality import BLOCKING_PX, HARMFUL_PX, blur_of_edges, sharpness
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import capture, is_unchecked, of_nobody


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
