"""The silhouette energy of lines against closed forms and finite differences."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ndtr

from fitter.energies import _line_kernels as kernels
from fitter.energies.correspondence_lines import (
    CorrespondenceLines,
    correspondence_lines,
    line_energy,
    line_rows,
)
from fitter.energies.scales import scales_at
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


REACH = 12
INDEPENDENCE = 0.2


def blurred_steps():
    steps = np.linspace(-kernels.BLUR, kernels.BLUR, 2 * kernels.BLUR * kernels.PLACES + 1)
    shares = ndtr(steps / 0.6)
    shares[0], shares[-1] = 0.0, 1.0
    return shares


def sides(rng, count):
    """Rows of means and covariances."""
    means = rng.uniform(0.2, 0.8, (count, 3))
    factors = 0.05 * rng.normal(size=(count, 3, 3))
    covariances = factors @ factors.swapaxes(1, 2) + 0.012**2 * np.eye(3)
    return np.hstack([means, covariances[:, *np.triu_indices(3)]])


def plain_costs(sample, inside, outside, share):
    """Negative log density of one sample that shows a share of the person."""
    covariance = np.zeros((3, 3))
    first, second = np.triu_indices(3)
    upper = share**2 * inside[3:] + (1.0 - share) ** 2 * outside[3:]
    covariance[first, second] = covariance[second, first] = upper
    away = sample - share * inside[:3] - (1.0 - share) * outside[:3]
    nats = 0.5 * away @ np.linalg.solve(covariance, away)
    nats += 0.5 * np.linalg.slogdet(2.0 * np.pi * covariance)[1]
    likely = (1.0 - kernels.ODD_SHARE) * np.exp(-nats) if nats < kernels.NEGLIGIBLE else 0.0
    return -np.log(likely + kernels.ODD_SHARE)


def plain_posterior(samples, first, last, lowest, highest, inside, outside):
    """Mean and variance over the candidate places of one line."""
    shares = blurred_steps()
    places = np.arange(np.ceil(lowest * kernels.PLACES), np.floor(highest * kernels.PLACES) + 1.0)
    costs = np.zeros(len(places))
    for index, place in enumerate(places):
        for j in range(first, last + 1):
            depth = int(place) - (j - REACH) * kernels.PLACES + kernels.BLUR * kernels.PLACES
            share = shares[np.clip(depth, 0, len(shares) - 1)]
            costs[index] += INDEPENDENCE * plain_costs(samples[j], inside, outside, share)
    likelihood = np.exp(costs.min() - costs)
    likelihood /= likelihood.sum()
    mean = likelihood @ places / kernels.PLACES
    return mean, likelihood @ (places / kernels.PLACES - mean) ** 2


def test_posteriors_are_those_of_the_sum_over_all_samples_and_places():
    rng = np.random.default_rng(6)
    count = 24
    inside, outside = sides(rng, count), sides(rng, count)
    outside[: count // 2, :3] = inside[: count // 2, :3] + 0.1
    samples = np.where(
        np.arange(2 * REACH + 1)[:, None] < REACH + rng.integers(-4, 5, (count, 1, 1)),
        inside[:, None, :3],
        outside[:, None, :3],
    ) + 0.03 * rng.normal(size=(count, 2 * REACH + 1, 3))
    first = rng.integers(0, REACH - 2, count)
    last = rng.integers(REACH + 3, 2 * REACH + 1, count)
    lowest = np.where(first > 0, -0.5 * (REACH - first), -7.0)
    highest = np.where(last < 2 * REACH, 0.5 * (last - REACH), 7.0)
    means, variances = np.empty((2, count))
    kernels.boundary_posteriors(
        samples, first, last, lowest, highest, inside, outside, blurred_steps(), INDEPENDENCE,
        means, variances,
    )  # fmt: skip
    plain = np.array(
        [
            plain_posterior(*each)
            for each in zip(samples, first, last, lowest, highest, inside, outside, strict=True)
        ]
    )
    assert np.ptp(plain[:, 0]) > 4.0
    np.testing.assert_allclose(means, plain[:, 0], atol=1e-8)
    np.testing.assert_allclose(variances, plain[:, 1], rtol=1e-6, atol=1e-10)


def test_lines_learn_from_near_ones_that_face_the_same_way():
    rng = np.random.default_rng(7)
    centres = rng.uniform(0.0, 300.0, (90, 2))
    angles = rng.uniform(0.0, 2.0 * np.pi, 90)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    sums = rng.uniform(size=(90, 10))
    apart = ((centres[:, None] - centres) ** 2).sum(axis=2)
    alike = np.maximum(normals @ normals.T, 0.0)
    dense = np.exp(-0.5 * apart / 20.0**2) * alike**2
    weights, others, starts = kernels.neighbours(centres, normals, 20.0)
    assert len(weights) < 0.5 * dense.size
    np.testing.assert_allclose(
        kernels.gathered(weights, others, starts, sums), dense @ sums, rtol=1e-9
    )


@pytest.mark.parametrize("x", np.linspace(-12.0, 12.0, 25))
def test_the_series_is_the_exponential_function(x):
    assert kernels._exponential(x) == pytest.approx(np.exp(x), rel=1e-9)
