"""Size charts: what body each size is made for, and what it costs to wear another one.

A chart says for every size, in some measurements, between which values the bodies lie that it is
made for. Where it gives one target in place of a range, the range reaches half way to the nearest
targets below and above, and beyond the last as far as on its other side.

How badly a size fits a body in one measurement is counted in tolerances:

    cost = max(v - high, 0) / t_small + max(low - v, 0) / t_large,    v = body + ease

The first term is of a size that is too small for the body (too tight, or too short), the second of
one too large. Unless the caller says otherwise, a size may be too large by one step of the chart,
the median distance from one size to the next in this measurement, and too small by half a step: too
small counts twice. A size *fits* where no measurement costs more than 1. Measurements of which a
size says nothing cost nothing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int

from fitter.errors import InvalidInputError
from fitter.remarks import FitWarning

TOO_SMALL_STEPS = 0.5
"""A size may be too small by this share of a step of the chart."""

TOO_LARGE_STEPS = 1.0
"""And too large by this."""

_SAME_CM = 1e-9

EQUAL_COST = 1e-9

_MOST_SAID = 3
"""Of a column's gaps so many are spelled out."""

BodyRange = tuple[float, float]
"""Low and high of the bodies a size is made for."""

Cell = BodyRange | float | None
"""A range, a target, or nothing said."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """How far a body may lie outside a size's range, in the measurement's unit; both positive."""

    too_small: float
    too_large: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SizeChart:
    """A chart whose targets have become ranges.

    Attributes
    ----------
    labels
        Of the sizes, in the chart's order.
    names
        Of the measurements.
    low, high
        (s, k) the bodies each size is made for; NaN where it says nothing.
    too_small, too_large
        (k,) the tolerances.
    """

    labels: tuple[str, ...]
    names: tuple[str, ...]
    low: Float[np.ndarray, "s k"]
    high: Float[np.ndarray, "s k"]
    too_small: Float[np.ndarray, " k"]
    too_large: Float[np.ndarray, " k"]

    @property
    def is_said(self) -> Bool[np.ndarray, "s k"]:
        """Whether a size says anything of a measurement."""
        return np.isfinite(self.low)


def size_chart(
    sizes: Mapping[str, Mapping[str, Cell]], tolerances: Mapping[str, Tolerance]
) -> SizeChart:
    """Build a chart from its cells: sizes by label, each with its measurements by name.

    Raises
    ------
    InvalidInputError
        ``tolerance-needed`` where all sizes have one and the same target, which says nothing of
        how far a body may be from it.
    """
    labels = tuple(sizes)
    names = tuple(dict.fromkeys(name for cells in sizes.values() for name in cells))
    columns = [
        _ranges([sizes[label].get(name) for label in labels]) for name in names
    ]  # each (s, 2)
    allowed = [
        tolerances.get(name) or _tolerance_of(name, column)
        for name, column in zip(names, columns, strict=True)
    ]
    return SizeChart(
        labels=labels,
        names=names,
        low=np.stack([column[:, 0] for column in columns], axis=1),
        high=np.stack([column[:, 1] for column in columns], axis=1),
        too_small=np.array([each.too_small for each in allowed]),
        too_large=np.array([each.too_large for each in allowed]),
    )


def costs(chart: SizeChart, values: Float[np.ndarray, "*n k"]) -> Float[np.ndarray, "*n s k"]:
    """What every size costs in every measurement; ``values`` are bodies with their ease."""
    beside = values[..., None, :]
    too_small = np.maximum(beside - chart.high, 0.0) / chart.too_small
    too_large = np.maximum(chart.low - beside, 0.0) / chart.too_large
    return np.where(chart.is_said, too_small + too_large, 0.0)


def off_centre(chart: SizeChart, values: Float[np.ndarray, "*n k"]) -> Float[np.ndarray, "*n s k"]:
    """How far bodies lie from the middle of each size, in tolerances: it tells equal costs apart.

    Ranges that overlap cost equally little.
    """
    middle = 0.5 * (chart.low + chart.high)
    return np.where(chart.is_said, np.abs(values[..., None, :] - middle) / chart.too_large, 0.0)


def size_of_least_cost(
    sums: Float[np.ndarray, "n s"], distances: Float[np.ndarray, "n s"]
) -> Int[np.ndarray, " n"]:
    """The size of least cost of each body; of several the one whose middle is nearest."""
    least = sums <= sums.min(axis=1, keepdims=True) + EQUAL_COST
    return np.where(least, distances, np.inf).argmin(axis=1)


def chart_remarks(chart: SizeChart, units: Sequence[str]) -> tuple[FitWarning, ...]:
    """What is odd about the ranges: ``chart-gap`` and ``chart-overlap``, once a column."""
    remarks: list[FitWarning] = []
    for column, (name, unit) in enumerate(zip(chart.names, units, strict=True)):
        ranges: dict[BodyRange, str] = {}
        for label, low, high in zip(
            chart.labels, chart.low[:, column], chart.high[:, column], strict=True
        ):
            if np.isfinite(low):
                ranges.setdefault((float(low), float(high)), label)
        said = sorted(ranges.items())
        gaps: list[str] = []
        overlaps: list[str] = []
        for ((_, high), label), ((low, _), next_label) in pairwise(said):
            if low > high + _SAME_CM:
                gaps.append(f"from {high:g} to {low:g} {unit} between {label} and {next_label}")
            elif low < high - _SAME_CM:
                overlaps.append(f"from {low:g} to {high:g} {unit} of {label} and {next_label}")
        if gaps:
            message = (
                f"No size is made for {name} {_listed(gaps)}: such a body is given to the nearer "
                "one, where too small counts twice."
            )
            remarks.append(FitWarning(code="chart-gap", message=message))
        if overlaps:
            message = (
                f"Sizes share {name} {_listed(overlaps)}: such a body is given to the one whose "
                "middle is nearer."
            )
            remarks.append(FitWarning(code="chart-overlap", message=message))
    return tuple(remarks)


def _listed(parts: Sequence[str]) -> str:
    more = len(parts) - _MOST_SAID
    said = ", ".join(parts[:_MOST_SAID])
    return f"{said} and {more} more" if more > 0 else said


def _ranges(cells: Sequence[Cell]) -> Float[np.ndarray, "s 2"]:
    """A column's cells as ranges, NaN where nothing is said."""
    targets = sorted({cell for cell in cells if isinstance(cell, float | int)})
    return np.array([_range(cell, targets) for cell in cells], dtype=np.float64)


def _range(cell: Cell, targets: Sequence[float]) -> BodyRange:
    if cell is None:
        return (np.nan, np.nan)
    if isinstance(cell, tuple):
        return cell
    place = targets.index(cell)
    below = [0.5 * (cell - each) for each in targets[place - 1 : place]] if place else []
    above = [0.5 * (each - cell) for each in targets[place + 1 : place + 2]]
    down = (below or above or [0.0])[0]
    up = (above or below or [0.0])[0]
    return (cell - down, cell + up)


def _tolerance_of(name: str, ranges: Float[np.ndarray, "s 2"]) -> Tolerance:
    """Steps of the chart; of sizes that are all alike the width of their range."""
    said = ranges[np.isfinite(ranges[:, 0])]
    middles = np.unique(said.mean(axis=1))
    steps = np.diff(middles)
    step = float(np.median(steps)) if len(steps) else float(np.diff(said, axis=1).max())
    if step <= _SAME_CM:
        raise InvalidInputError(
            code="tolerance-needed",
            field=f"tolerances.{name}",
            reason=f"All sizes of the chart have the same target of {name}, which does not say how "
            "far a body may be from it.",
            remedy="Give ranges, or this measurement's tolerance.",
        )
    return Tolerance(too_small=TOO_SMALL_STEPS * step, too_large=TOO_LARGE_STEPS * step)
