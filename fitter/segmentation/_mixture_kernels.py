"""Compiled loops of the colour mixtures. Plain arrays in and out; the wrappers document them.

A component is a row of ten numbers: its offset, its mean (3), and the upper triangle of a factor of
its precision (6), such that minus the logarithm of weight times density is
``offset + |factor (z - mean)|² / 2``, up to a constant that all components share.
"""

from math import factorial, log, sqrt
from typing import no_type_check

import numpy as np
from numba import njit

NEGLIGIBLE = np.float32(12.0)
"""Terms of a sum smaller than its largest by more than this many nats count as if they were not
smaller than that: at most 3e-5 nats."""

SERIES = tuple(np.float32(1.0 / factorial(n)) for n in range(8, -1, -1))
"""Taylor coefficients of the exponential function, the highest power first."""

MIDDLE = np.float32(sqrt(5.0))
LOGARITHM_OF_MIDDLE = np.float32(0.5 * log(5.0))
LOGARITHM = tuple(np.float32(2.0 / n) for n in range(11, 0, -2))
"""Coefficients of log(x / middle) in (x - middle) / (x + middle), the highest power first."""

BLOCK = 128
"""Colours per block, so that the loop over them is vectorised: 117,000 take 1.8 ms, not 4.4."""


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def likeliest_components(colours, components):
    """(s,) the component with the lowest cost for each colour; the first of equal ones."""
    count = colours.shape[0]
    chosen = np.empty(count, dtype=np.uint8)
    planes = np.zeros((3, BLOCK), dtype=np.float32)
    costs = np.empty((components.shape[0], BLOCK), dtype=np.float32)
    least = np.empty(BLOCK, dtype=np.float32)
    for start in range(0, count, BLOCK):
        filled = min(BLOCK, count - start)
        _block_costs(colours, start, filled, components, planes, costs, least)
        for i in range(filled):
            likeliest = 0
            for k in range(components.shape[0] - 1, -1, -1):
                likeliest = k if costs[k, i] == least[i] else likeliest
            chosen[start + i] = likeliest
    return chosen


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def mixture_costs(colours, components):
    """(s,) negative logarithm of the mixture's density at each colour."""
    count = colours.shape[0]
    result = np.empty(count, dtype=np.float32)
    planes = np.zeros((3, BLOCK), dtype=np.float32)
    costs = np.empty((components.shape[0], BLOCK), dtype=np.float32)
    least = np.empty(BLOCK, dtype=np.float32)
    totals = np.empty(BLOCK, dtype=np.float32)
    for start in range(0, count, BLOCK):
        filled = min(BLOCK, count - start)
        _block_costs(colours, start, filled, components, planes, costs, least)
        totals[:] = 0.0
        for k in range(components.shape[0]):
            row = costs[k]
            for i in range(BLOCK):
                beyond = min(row[i] - least[i], NEGLIGIBLE)
                totals[i] += _falling(beyond)
        for i in range(BLOCK):
            totals[i] = least[i] - _logarithm(totals[i])
        result[start : start + filled] = totals[:filled]
    return result


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def _falling(x):
    """exp(-x) for x from 0 to :data:`NEGLIGIBLE`, to 3e-6 of itself: a series, vectorised."""
    y = x * np.float32(-1.0 / 16.0)
    power = SERIES[0]
    for n in range(1, len(SERIES)):
        power = SERIES[n] + power * y
    power *= power
    power *= power
    power *= power
    return power * power


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def _logarithm(x):
    """log(x) for x from 1 to 5, to 1e-5: a series, vectorised."""
    y = (x - MIDDLE) / (x + MIDDLE)
    square = y * y
    power = LOGARITHM[0]
    for n in range(1, len(LOGARITHM)):
        power = LOGARITHM[n] + power * square
    return LOGARITHM_OF_MIDDLE + y * power


@no_type_check
@njit(cache=True, nogil=True)
def component_sums(colours, chosen, count):
    """(k, 10) count, sum (3) and sums of products (rr, rg, rb, gg, gb, bb) by component."""
    sums = np.zeros((count, 10))
    for i in range(colours.shape[0]):
        k = chosen[i]
        r = np.float64(colours[i, 0])
        g = np.float64(colours[i, 1])
        b = np.float64(colours[i, 2])
        sums[k, 0] += 1.0
        sums[k, 1] += r
        sums[k, 2] += g
        sums[k, 3] += b
        sums[k, 4] += r * r
        sums[k, 5] += r * g
        sums[k, 6] += r * b
        sums[k, 7] += g * g
        sums[k, 8] += g * b
        sums[k, 9] += b * b
    return sums


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def _block_costs(colours, start, filled, components, planes, costs, least):
    """Costs (k, BLOCK) of the colours from ``start`` on, and the lowest of each (BLOCK,)."""
    red, green, blue = planes[0], planes[1], planes[2]
    for i in range(filled):
        red[i] = colours[start + i, 0]
        green[i] = colours[start + i, 1]
        blue[i] = colours[start + i, 2]
    least[:] = np.inf
    half = np.float32(0.5)
    for k in range(components.shape[0]):
        offset = components[k, 0]
        mean_r, mean_g, mean_b = components[k, 1], components[k, 2], components[k, 3]
        rr, rg, rb = components[k, 4], components[k, 5], components[k, 6]
        gg, gb, bb = components[k, 7], components[k, 8], components[k, 9]
        row = costs[k]
        for i in range(BLOCK):
            r, g, b = red[i] - mean_r, green[i] - mean_g, blue[i] - mean_b
            x = rr * r + rg * g + rb * b
            y = gg * g + gb * b
            z = bb * b
            cost = offset + half * (x * x + y * y + z * z)
            row[i] = cost
            least[i] = cost if cost < least[i] else least[i]
