"""Boundaries on lines: closed forms on drawn pictures."""

import numpy as np
import pytest

from fitter.evidence.correspondence_lines import CorrespondenceLines, correspondence_lines
from tests.unit.evidence.drawn_pictures import (
    HEIGHT,
    PIXELS_PER_METRE,
    SKIN,
    WALL,
    WIDTH,
    boxes,
    coverage,
    picture,
)

SURE = np.ones((HEIGHT, WIDTH), dtype=np.float32)
LEFT, RIGHT = 130.0, 190.0


def noisy(values: np.ndarray, deviation: float = 0.01) -> np.ndarray:
    noise = np.random.default_rng(7).standard_normal(values.shape)
    return np.clip(values + deviation * noise, 0.0, 1.0).astype(np.float32)


def found(display: np.ndarray, *spans: tuple[float, float]) -> CorrespondenceLines:
    rendering, edges = boxes(*spans)
    return correspondence_lines(rendering, edges, display, SURE)


def beside(lines: CorrespondenceLines, way: float) -> np.ndarray:
    """Lines that cross an upright border, leftward or rightward, away from the corners."""
    upright = lines.normals[:, 0] * way > 0.99
    return upright & (np.abs(lines.centres[:, 1] - 120.0) < 60.0)


@pytest.mark.parametrize("shift", [-3.2, -2.25, -0.3, 0.0, 0.4, 3.1])
def test_boundaries_are_found_to_a_tenth_of_a_pixel(shift: float):
    lines = found(noisy(picture(SKIN, WALL, coverage(LEFT, RIGHT + shift))), (LEFT, RIGHT))
    right, left = beside(lines, 1.0), beside(lines, -1.0)
    assert right.sum() > 20
    assert left.sum() > 20
    assert lines.offsets[right].mean() == pytest.approx(shift, abs=0.1)
    assert np.abs(lines.offsets[right] - shift).max() < 0.5
    assert lines.offsets[left].mean() == pytest.approx(0.0, abs=0.1)


@pytest.mark.parametrize("shift", [-6.0, 5.6])
def test_a_body_far_off_is_shown_most_of_the_way(shift: float):
    """Half of what it learns from lies on the wrong side; laid out anew the lines show the rest."""
    lines = found(noisy(picture(SKIN, WALL, coverage(LEFT, RIGHT + shift))), (LEFT, RIGHT))
    shown = lines.offsets[beside(lines, 1.0)].mean()
    assert 0.6 < shown / shift < 1.05


def test_dark_and_light_give_the_same_boundary():
    share = coverage(LEFT, RIGHT + 1.4)
    for person, wall in ((SKIN, WALL), (WALL, SKIN)):
        lines = found(noisy(picture(person, wall, share)), (LEFT, RIGHT))
        assert lines.offsets[beside(lines, 1.0)].mean() == pytest.approx(1.4, abs=0.1)


def test_a_rough_wall_draws_the_boundary_no_farther_than_a_third_of_a_pixel():
    rough = WALL + 0.15 * np.random.default_rng(3).standard_normal((HEIGHT, WIDTH, 1))
    lines = found(noisy(picture(SKIN, rough, coverage(LEFT, RIGHT + 2.0))), (LEFT, RIGHT))
    right = beside(lines, 1.0)
    weights = 1.0 / (0.5 + lines.variances[right])
    assert np.average(lines.offsets[right], weights=weights) == pytest.approx(2.0, abs=0.33)


def test_colours_are_learnt_on_the_spot():
    """Above, the wall has the colour the person has below, so no one colour model would do."""
    above = (np.arange(HEIGHT) < 120)[:, None, None]
    person = np.where(above, SKIN, WALL)
    wall = np.where(above, WALL, SKIN)
    lines = found(noisy(picture(person, wall, coverage(LEFT, RIGHT + 2.0))), (LEFT, RIGHT))
    for half in (lines.centres[:, 1] < 100.0, lines.centres[:, 1] > 140.0):
        chosen = beside(lines, 1.0) & half
        assert lines.offsets[chosen].mean() == pytest.approx(2.0, abs=0.2)


def test_where_both_sides_look_alike_a_line_says_that_it_does_not_know():
    above = (np.arange(HEIGHT) < 120)[:, None, None]
    wall = np.where(above, WALL, SKIN)
    lines = found(noisy(picture(SKIN, wall, coverage(LEFT, RIGHT))), (LEFT, RIGHT))
    told = beside(lines, 1.0) & (lines.centres[:, 1] < 100.0)
    untold = beside(lines, 1.0) & (lines.centres[:, 1] > 140.0)
    assert lines.variances[told].max() < 0.3
    assert np.median(lines.variances[untold]) > 4.0


def test_less_contrast_makes_a_boundary_less_certain():
    variances = []
    for contrast in (1.0, 0.2, 0.1):
        wall = SKIN + contrast * (WALL - SKIN)
        lines = found(
            noisy(picture(SKIN, wall, coverage(LEFT, RIGHT)), deviation=0.02), (LEFT, RIGHT)
        )
        variances.append(np.median(lines.variances[beside(lines, 1.0)]))
    assert variances[0] < variances[1] < variances[2]


def test_lines_end_before_the_next_limb():
    """Between two boxes 10 px apart a boundary lies in the near half of the gap."""
    shares = coverage(100.0, 150.0) + coverage(160.0, 210.0)
    lines = found(noisy(picture(SKIN, WALL, shares)), (100.0, 150.0), (160.0, 210.0))
    gap = beside(lines, 1.0) & (lines.centres[:, 0] < 155.0)
    assert gap.sum() > 20
    np.testing.assert_allclose(lines.offsets[gap], 0.0, atol=0.5)


def test_a_gap_too_narrow_to_see_into_has_no_lines():
    lines = found(
        noisy(picture(SKIN, WALL, coverage(100.0, 210.0))), (100.0, 153.0), (156.0, 210.0)
    )
    assert not (beside(lines, 1.0) & (lines.centres[:, 0] < 156.0)).any()


def test_lines_stand_for_the_whole_contour_and_carry_the_confidence_there():
    rendering, edges = boxes((LEFT, RIGHT))
    doubtful = SURE.copy()
    doubtful[:100] = 0.05
    display = noisy(picture(SKIN, WALL, coverage(LEFT, RIGHT)))
    lines = correspondence_lines(rendering, edges, display, doubtful)
    around = 2.0 * (RIGHT - LEFT + 160.0)
    assert lines.spacing * len(lines.offsets) == pytest.approx(around, rel=0.05)
    np.testing.assert_allclose(lines.confidence[lines.centres[:, 1] < 98.0], 0.05, rtol=1e-5)
    np.testing.assert_allclose(lines.confidence[lines.centres[:, 1] > 102.0], 1.0)


def test_a_body_that_is_out_of_the_picture_has_no_lines():
    lines = found(noisy(picture(SKIN, WALL, coverage(LEFT, RIGHT))), (1130.0, 1190.0))
    assert len(lines.offsets) == 0
    assert lines.points.shape == (0, 2)


def test_the_window_is_a_length_on_the_body():
    """A boundary far beyond it is not looked for."""
    shift = 0.04 * PIXELS_PER_METRE
    lines = found(noisy(picture(SKIN, WALL, coverage(LEFT, RIGHT + shift))), (LEFT, RIGHT))
    assert np.abs(lines.offsets).max() <= 0.025 * PIXELS_PER_METRE + 1.0
