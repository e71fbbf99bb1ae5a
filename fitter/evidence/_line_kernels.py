"""Compiled loops over correspondence lines. Plain arrays in and out; the wrappers document them.

Sample j of a line lies ``j - reach`` pixels outside its centre. ``first`` and ``last`` (k,) are the
samples of each line that can be used, inclusive. A side is a row of nine numbers: the mean of its
colours and the upper triangle of their covariance.
"""

from math import exp, log, pi, sqrt
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


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def usable_samples(silhouette, centres, normals, reach, first, last):
    """How far each line runs inside the body on one side, and outside it on the other.

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
def boundary_posteriors(
    samples, first, last, lowest, highest, inside, outside, coverage, independence, means, variances
):
    """Mean and variance of where each line's boundary lies, pixels outside its centre.

    With a boundary at x, a sample at r shows a share α of the person, ``coverage`` of x - r; the
    sample is then normal about α m₁ + (1-α) m₂ with covariance α² C₁ + (1-α)² C₂. The prior is
    uniform between ``lowest`` and ``highest``.
    """
    reach = (samples.shape[1] - 1) // 2
    mixtures = coverage.shape[0]
    costs = np.empty((samples.shape[1], mixtures))
    places = np.empty((2 * reach * PLACES + 1, 2))
    for k in range(samples.shape[0]):
        _pixel_costs(samples[k], first[k], last[k], inside[k], outside[k], coverage, costs)
        count = 0
        least = NEVER
        start = int(np.ceil(lowest[k] * PLACES))
        for step in range(start, int(np.floor(highest[k] * PLACES)) + 1):
            total = 0.0
            for j in range(first[k], last[k] + 1):
                depth = step - (j - reach) * PLACES + BLUR * PLACES
                total += costs[j, min(max(depth, 0), mixtures - 1)]
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
def _pixel_costs(samples, first, last, inside, outside, coverage, costs):
    """Negative log density of each sample for each share of the person it may show."""
    factor = np.empty(6)
    covariance = np.empty(6)
    odd = -log(ODD_SHARE)
    for m in range(coverage.shape[0]):
        share = coverage[m]
        rest = 1.0 - share
        for c in range(6):
            covariance[c] = share * share * inside[3 + c] + rest * rest * outside[3 + c]
        norm = _inverse_factor(covariance, factor) + 1.5 * log(2.0 * pi)
        red = share * inside[0] + rest * outside[0]
        green = share * inside[1] + rest * outside[1]
        blue = share * inside[2] + rest * outside[2]
        for j in range(first, last + 1):
            x, y, z = samples[j, 0] - red, samples[j, 1] - green, samples[j, 2] - blue
            u = factor[0] * x
            v = factor[1] * x + factor[2] * y
            w = factor[3] * x + factor[4] * y + factor[5] * z
            nats = 0.5 * (u * u + v * v + w * w) + norm
            # Anything this unlikely is odd: that spares the logarithm for most samples and shares.
            costs[j, m] = odd
            if nats < NEGLIGIBLE:
                costs[j, m] = -log((1.0 - ODD_SHARE) * exp(-nats) + ODD_SHARE)


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
