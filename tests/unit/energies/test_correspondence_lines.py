"""The silhouette energy of lines against closed forms and finite differences."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.correspondence_lines import line_energy, line_rows
from fitter.energies.scales import scales_at
from fitter.evidence.correspondence_lines import CorrespondenceLines, correspondence_lines
from fitter.render.rasterizer import Rendering, render
from tests.unit.evidence.drawn_pictures import (
    CAMERA,
    DEPTH_M,
    HEIGHT,
    PIXELS_PER_METRE,
    SKIN,
    WALL,
    WIDTH,
    boxes,
    coverage,
    picture,
)

SCALES = scales_at(CAMERA, DEPTH_M, boundary_eta_m=0.02)


@pytest.fixture(scope="module")
def lined() -> tuple[Rendering, CorrespondenceLines]:
    """A box whose right border stands 2 px short of the picture's."""
    rendering, edges = boxes((130.0, 190.0))
    display = picture(SKIN, WALL, coverage(130.0, 192.0))
    noise = np.random.default_rng(5).standard_normal(display.shape)
    sure = np.ones((HEIGHT, WIDTH), dtype=np.float32)
    return rendering, correspondence_lines(rendering, edges, display + 0.01 * noise, sure)


def moved(rendering: Rendering, by: np.ndarray) -> Rendering:
    return render(rendering.vertices + by, rendering.triangles, rendering.camera)


def test_a_contour_that_stands_where_the_lines_say_costs_nothing(lined):
    rendering, lines = lined
    there = replace(lines, offsets=np.zeros(len(lines.offsets)))
    assert line_energy(rendering, there, SCALES) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("shift", [1.0, 3.0, 40.0])
def test_a_shift_costs_the_robust_square_of_it_by_each_lines_variance(lined, shift: float):
    rendering, lines = lined
    known = replace(lines, offsets=np.zeros(len(lines.offsets)))
    aside = moved(rendering, np.array([shift / PIXELS_PER_METRE, 0.0, 0.0]))
    upright = np.abs(lines.normals[:, 0])  # The front face is square to the camera.
    residuals = shift * upright
    robust = 0.5 * residuals**2 / (1 + (residuals / SCALES.silhouette_eta) ** 2)
    variances = SCALES.contour_sigma**2 + lines.variances
    expected = (robust / variances).sum() * lines.spacing / SCALES.line_correlation_length
    assert line_energy(aside, known, SCALES) == pytest.approx(expected, rel=0.05)


def test_an_uncertain_line_counts_less(lined):
    rendering, lines = lined
    aside = moved(rendering, np.array([0.01, 0.0, 0.0]))
    vague = replace(lines, variances=lines.variances + 10.0)
    assert line_energy(aside, vague, SCALES) < 0.4 * line_energy(aside, lines, SCALES)


@pytest.mark.parametrize("cloth", [0.0, 0.3, 1.0])
def test_rows_are_the_exact_slope_of_the_energy(lined, cloth: float):
    rendering, lines = lined
    full = np.random.default_rng(2).uniform(0.0, 1.5, (len(lines.offsets), 2))
    lines = replace(lines, cloth=np.full(len(lines.offsets), cloth), fullness=full)
    slope = np.zeros_like(rendering.vertices)
    for rows in line_rows(rendering, lines, SCALES):
        force = (rows.weights * rows.residuals)[:, None, None] * rows.derivatives
        np.add.at(slope, rows.points, force)
    rng = np.random.default_rng(1)
    for _ in range(3):
        direction = rng.standard_normal(rendering.vertices.shape)
        step = 3e-8  # The bound begins at a line's boundary: little may cross it.
        gained = [
            line_energy(moved(rendering, sign * step * direction), lines, SCALES)
            for sign in (-1.0, 1.0)
        ]
        expected = (gained[1] - gained[0]) / (2 * step)
        assert (slope * direction).sum() == pytest.approx(expected, rel=1e-5, abs=1e-6)


def test_rows_pull_the_contour_to_the_boundary(lined):
    rendering, lines = lined
    (rows,) = line_rows(rendering, lines, SCALES)
    right = lines.normals[:, 0] > 0.99
    push = -(rows.weights * rows.residuals)[:, None] * rows.derivatives.sum(axis=1)
    assert push[right, 0].sum() > 0.0
    # 2 px where a metre has 300: as far as each line would move its own contour.
    steps = -rows.residuals[right] / rows.derivatives[right].sum(axis=1)[:, 0]
    assert np.median(steps) == pytest.approx(2.0 / PIXELS_PER_METRE, rel=0.1)
