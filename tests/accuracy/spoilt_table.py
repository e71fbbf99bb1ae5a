"""Measurements of people in spoilt pictures as text."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from tests.accuracy.clothing_table import plus_minus
from tests.accuracy.spoilt import Measured
from tests.accuracy.table import INTERVALS, MEASUREMENTS

LEVEL, DEVIATIONS = INTERVALS[1]
COMPARED = [each for each in MEASUREMENTS if each[0] != "navel"]


def spoilt_heading() -> str:
    """Above :func:`spoilt_lines`: mean absolute error with its standard error over people (bias),
    the median width of 95 % intervals, how many of 100 true values they hold."""
    columns = "".join(
        f"{f'{name} {unit}':>18s}{'width':>6s}{'hold':>5s}" for name, _, unit in COMPARED
    )
    return f"{'kind':26s}{'points':9s}{'n':>3s}{columns}{'all hold':>10s}{'withheld':>9s}  findings"


def spoilt_lines(found: Sequence[Measured]) -> list[str]:
    """One line a kind, with clicks and with proposals; of what is withheld nothing counts."""
    lines: list[str] = []
    for kind in dict.fromkeys(each.asked.kind for each in found):
        for proposed in (False, True):
            these = [
                each
                for each in found
                if each.asked.kind == kind and each.asked.proposed is proposed
            ]
            if these:
                lines.append(_line(kind, "proposed" if proposed else "clicked", these))
    return lines


def _line(kind: str, points: str, these: Sequence[Measured]) -> str:
    shown = [each for each in these if not each.withheld]
    line = f"{kind:26s}{points:9s}{len(these):3d}"
    for _, key, _ in COMPARED:
        line += _cells(key, shown)
    shares = [
        100.0 * float(np.mean([_holds(each, key) for _, key, _ in COMPARED])) for each in shown
    ]
    share = f"{np.mean(shares):.0f}{plus_minus(shares, 0)}" if shares else "-"
    counts = Counter(code for each in these for code in each.findings)
    said = ", ".join(f"{code} {count}" for code, count in counts.most_common())
    return f"{line}{share:>10s}{len(these) - len(shown):9d}  {said}".rstrip()


def _cells(key: str, shown: Sequence[Measured]) -> str:
    if not shown:
        return f"{'-':>18s}{'-':>6s}{'-':>5s}"
    errors = np.array([each.errors[key] for each in shown])
    away = np.abs(errors)
    width = np.median([2.0 * DEVIATIONS * each.standard_errors[key] for each in shown])
    held = 100.0 * np.mean([_holds(each, key) for each in shown])
    mean = f"{away.mean():.1f}{plus_minus(away, 1)} ({errors.mean():+.1f})"
    return f"{mean:>18s}{width:6.1f}{held:5.0f}"


def _holds(each: Measured, key: str) -> bool:
    return abs(each.errors[key]) <= DEVIATIONS * each.standard_errors[key]
