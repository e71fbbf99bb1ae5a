"""Compiled loops over correspondence lines. Plain arrays in and out; the wrappers document them.

Sample j of a line lies ``j - reach`` pixels outside its centre. ``first`` and ``last`` (k,) are the
samples of each line that can be used, inclusive. A side is a row of nine numbers: the mean of its
colours and the upper triangle of their covariance.
"""

from math import exp, factorial, log, pi, sqrt
from typing import no_type_check

import numpy as np
from numba import njit

PLACES = 4
"""Candidate places for the boundary per pixel."""

BLUR = 2
"""Distance from a boundary, pixels, beyond which a pixel shows one side only."""

ODD_SHARE = 0.02
"""Share of pixels with neither side's colours: a highlight, a strand of hair, a joint of a wall.
For them every colour of the unit cube is equally likely, so that none can mislead a line."""

NEGLIGIBLE = 12.0
"""Negative logarithm of a density that is negligible against that of odd pixels."""

NEVER = 1e300

UNRELATED = 30.0
"""Negative logarithm of a neighbour's weight that is not worth counting."""


SERIES = tuple(1.0 / factorial(n) for n in range(12, -1, -1))
"""Taylor coefficients of the exponential function, the highest power first."""


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def usable_samples(silhouette, centres, normals, reach, first, last):
    """Samples of each line inside the body on one side, and outside it on the other.

    The pixel next to the centre may be on either side of the outline; the last one before another
    outline is left out, because that outline may be misplaced.
    """
    height, width = silhouette.shape
    for k in range(centres.shape[0]):
        for side in (-1, 1):
            farthest = reach
            for r in range(1, reach + 1):
                column = int(np.floor(centres[k, 0] + side * r * normals[k, 0]))
                row = int(np.floor(centres[k, 1] + side * r * normals[k, 1]))
                outside = not (0 <= row < height and 0 <= column < width)
                if outside or (r > 1 and silhouette[row, column] == (side > 0)):
                    farthest = max(r - 2, 0)
                    break
            if side < 0:
                first[k] = reach - farthest
            else:
                last[k] = reach + farthest


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def sample_lines(picture, centres, normals, first, last, samples):
    """Colours along each line by bilinear interpolation, into ``samples`` (k, 2 reach + 1, 3)."""
    height, width = picture.shape[:2]
    reach = (samples.shape[1] - 1) // 2
    for k in range(centres.shape[0]):
        for j in range(first[k], last[k] + 1):
            x = centres[k, 0] + (j - reach) * normals[k, 0] - 0.5
            y = centres[k, 1] + (j - reach) * normals[k, 1] - 0.5
            column = min(max(int(np.floor(x)), 0), width - 2)
            row = min(max(int(np.floor(y)), 0), height - 2)
            u = min(max(x - column, 0.0), 1.0)
            v = min(max(y - row, 0.0), 1.0)
            for c in range(3):
                above = (1 - u) * picture[row, column, c] + u * picture[row, column + 1, c]
                below = (1 - u) * picture[row + 1, column, c] + u * picture[row + 1, column + 1, c]
                samples[k, j, c] = (1 - v) * above + v * below


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def side_sums(samples, first, last, boundaries, least, most, inside, outside):
    """Sums of 1, z and the upper triangle of z zᵀ on either side of each boundary; (k, 10) each.

    Only samples between ``least`` and ``most`` pixels from the boundary count.
    """
    reach = (samples.shape[1] - 1) // 2
    inside[:] = 0.0
    outside[:] = 0.0
    for k in range(samples.shape[0]):
        for j in range(first[k], last[k] + 1):
            away = j - reach - boundaries[k]
            if abs(away) < least or abs(away) > most:
                continue
            sums = outside[k] if away > 0.0 else inside[k]
            sums[0] += 1.0
            place = 4
            for a in range(3):
                sums[1 + a] += samples[k, j, a]
                for b in range(a, 3):
                    sums[place] += samples[k, j, a] * samples[k, j, b]
                    place += 1


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def neighbours(centres, normals, spread):
    """Weights with which lines learn from one another: near ones that face the same way.

    Returns the pairs' weights one line after the other, the other line of each, and where each
    line's begin. Weights below a ten-billionth are left out: nearly all.
    """
    count = centres.shape[0]
    scale = 0.5 / spread**2
    starts = np.zeros(count + 1, dtype=np.int64)
    others = np.empty(count * count, dtype=np.int32)
    weights = np.empty(count * count)
    total = 0
    for i in range(count):
        for j in range(count):
            x, y = centres[i, 0] - centres[j, 0], centres[i, 1] - centres[j, 1]
            exponent = scale * (x * x + y * y)
            alike = normals[i, 0] * normals[j, 0] + normals[i, 1] * normals[j, 1]
            if exponent < UNRELATED and alike > 0.0:
                others[total] = j
                weights[total] = exp(-exponent) * alike * alike
                total += 1
        starts[i + 1] = total
    return weights[:total].copy(), others[:total].copy(), starts


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def gathered(weights, others, starts, sums):
    """The lines' ``sums`` (k, c) weighted over each line's neighbours."""
    result = np.zeros(sums.shape)
    for i in range(sums.shape[0]):
        for pair in range(starts[i], starts[i + 1]):
            weight, other = weights[pair], others[pair]
            for c in range(sums.shape[1]):
                result[i, c] += weight * sums[other, c]
    return result


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def boundary_posteriors(
    samples, first, last, lowest, highest, inside, outside, coverage, independence, means, variances
):
    """Mean and variance of where each line's boundary lies, pixels outside its centre.

    With a boundary at x, a sample at r shows a share α of the person, ``coverage`` of x - r; the
    sample is then normal about α m₁ + (1-α) m₂ with covariance α² C₁ + (1-α)² C₂. The prior is
    uniform between ``lowest`` and ``highest``.
    """
    reach = (samples.shape[1] - 1) // 2
    blurred = 2 * BLUR * PLACES + 1
    densities = np.empty((blurred, samples.shape[1]))
    planes = np.empty((3, samples.shape[1]))
    # Costs of all samples before one, if they show the person, and if they show the background.
    person = np.zeros(samples.shape[1] + 1)
    background = np.zeros(samples.shape[1] + 1)
    places = np.empty((2 * reach * PLACES + 1, 2))
    for k in range(samples.shape[0]):
        start = int(np.ceil(lowest[k] * PLACES))
        stop = int(np.floor(highest[k] * PLACES)) + 1
        near = max(first[k], reach + start // PLACES - BLUR)
        far = min(last[k], reach + stop // PLACES + BLUR)
        for j in range(first[k], last[k] + 1):
            for c in range(3):
                planes[c, j] = samples[k, j, c]
        _pixel_densities(
            planes, first[k], last[k], near, far, inside[k], outside[k], coverage, densities
        )
        for j in range(first[k], last[k] + 1):
            person[j + 1] = person[j] - log(densities[blurred - 1, j])
            background[j + 1] = background[j] - log(densities[0, j])
        count = 0
        least = NEVER
        for step in range(start, stop):
            # Samples up to ``inner`` show the person alone, those from ``outer`` on the background.
            inner = min(max((step - BLUR * PLACES) // PLACES + reach, first[k] - 1), last[k])
            outer = max(-((-step - BLUR * PLACES) // PLACES) + reach, inner + 1)
            outer = min(outer, last[k] + 1)
            total = person[inner + 1] - person[first[k]] + background[last[k] + 1]
            total -= background[outer]
            mixed = 1.0
            for j in range(inner + 1, outer):
                mixed *= densities[step - (j - reach) * PLACES + BLUR * PLACES, j]
            total -= log(mixed)
            places[count, 0] = step / PLACES
            places[count, 1] = independence * total
            least = min(least, places[count, 1])
            count += 1
        mass = moment = square = 0.0
        for i in range(count):
            likelihood = exp(least - places[i, 1])
            mass += likelihood
            moment += likelihood * places[i, 0]
            square += likelihood * places[i, 0] * places[i, 0]
        means[k] = moment / mass
        variances[k] = max(square / mass - means[k] * means[k], 0.0)


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def _pixel_densities(planes, first, last, near, far, inside, outside, coverage, densities):
    """Density of each sample for each share of the person it may show.

    Only samples from ``near`` to ``far`` may show both sides.
    """
    factor = np.empty(6)
    covariance = np.empty(6)
    for m in range(coverage.shape[0]):
        share = coverage[m]
        rest = 1.0 - share
        for c in range(6):
            covariance[c] = share * share * inside[3 + c] + rest * rest * outside[3 + c]
        norm = _inverse_factor(covariance, factor) + 1.5 * log(2.0 * pi)
        red = share * inside[0] + rest * outside[0]
        green = share * inside[1] + rest * outside[1]
        blue = share * inside[2] + rest * outside[2]
        one_side = m in (0, coverage.shape[0] - 1)
        start, stop = (first, last + 1) if one_side else (near, far + 1)
        row, reds = densities[m, start:stop], planes[0, start:stop]
        greens, blues = planes[1, start:stop], planes[2, start:stop]
        for i in range(row.size):
            x, y, z = reds[i] - red, greens[i] - green, blues[i] - blue
            u = factor[0] * x
            v = factor[1] * x + factor[2] * y
            w = factor[3] * x + factor[4] * y + factor[5] * z
            nats = 0.5 * (u * u + v * v + w * w) + norm
            # Anything this unlikely is odd.
            likely = (1.0 - ODD_SHARE) * _exponential(-min(nats, NEGLIGIBLE))
            row[i] = ODD_SHARE + (likely if nats < NEGLIGIBLE else 0.0)


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def _exponential(x):
    """e^x for |x| up to 12, to 1e-9 of itself: a series, which is vectorised."""
    y = 0.0625 * x
    power = SERIES[0]
    for n in range(1, len(SERIES)):
        power = SERIES[n] + power * y
    power *= power
    power *= power
    power *= power
    return power * power


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def _inverse_factor(covariance, factor):
    """L⁻¹ of C = L Lᵀ, its lower triangle row by row; returns half the logarithm of |C|."""
    a = sqrt(covariance[0])
    b, c = covariance[1] / a, covariance[2] / a
    d = sqrt(covariance[3] - b * b)
    e = (covariance[4] - b * c) / d
    f = sqrt(covariance[5] - c * c - e * e)
    factor[0] = 1.0 / a
    factor[1] = -b / (a * d)
    factor[2] = 1.0 / d
    factor[3] = (b * e - c * d) / (a * d * f)
    factor[4] = -e / (d * f)
    factor[5] = 1.0 / f
    return log(a * d * f)
