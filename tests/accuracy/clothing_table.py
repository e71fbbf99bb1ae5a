"""People in clothes: errors by what is said, by garment, and without a picture, as text.

Figures of several people are followed by the standard error of their mean.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from tests.accuracy.dressed_scores import NOTHING_SAID, SAID, DressedScore
from tests.accuracy.scoring import Scored
from tests.accuracy.seen_labels import CLASSES
from tests.accuracy.table import INTERVALS, MEASUREMENTS, held

LEVEL, DEVIATIONS = INTERVALS[1]
KEYS = tuple(key for _, key, _ in MEASUREMENTS)

WIDEST_CLASS = 39

KNOWN = 0.05
"""Errors of what is known are smaller: they are rounded to nothing."""


def case_heading() -> str:
    """Above :func:`case_lines`."""
    columns = "".join(f"{f'{name} {unit}':>13s}" for name, _, unit in MEASUREMENTS)
    return f"{'case':40s}{'said':14s}{columns}{'vertex mm':>11s}{'joint mm':>10s}  worn"


def case_lines(scores: Sequence[DressedScore]) -> list[str]:
    """Signed errors and standard errors of each fit of a picture."""
    return [_case_line(each) for each in scores]


def clothing_lines(scores: Sequence[DressedScore]) -> list[str]:
    """Sums by what is said, by garment, and how well skin and cloth are told apart."""
    lines = _summary_heading("said")
    for said in SAID:
        lines += _summary(said, [each.scored for each in scores if each.said == said])
    unsaid = [each for each in scores if each.said == NOTHING_SAID]
    lines += ["", *_summary_heading("worn, nothing said")]
    for outfit in dict.fromkeys(each.outfit for each in unsaid):
        lines += _summary(outfit, [each.scored for each in unsaid if each.outfit == outfit])
    return [*lines, *label_lines(unsaid)]


def null_heading() -> list[str]:
    """Above :func:`null_lines` where no table with its columns is."""
    return ["", _columns("without a picture")]


def null_lines(nulls: Mapping[str, Sequence[Mapping[str, float]]]) -> list[str]:
    """Errors of what is said without a picture, by what is known; a dash for what is known."""
    lines: list[str] = []
    for title, errors in nulls.items():
        columns = [[each[key] for each in errors] for key in KEYS]
        cells = [_errors(column) if np.any(np.abs(column) > KNOWN) else "-" for column in columns]
        line = f"{title:{WIDEST_CLASS}s}{len(errors):3d}"
        lines.append(line + "".join(f"{cell:>26s}" for cell in cells))
    return lines


def underwear_lines(dressed: Sequence[DressedScore], undressed: Sequence[Scored]) -> list[str]:
    """The same people in underwear, and those in close-fitting clothes beside themselves."""
    lines = _summary("the same people in underwear", undressed)
    by_person = {each.person: each for each in undressed}
    close = [
        each.scored
        for each in dressed
        if each.said == NOTHING_SAID and each.outfit.startswith("close-fitting")
    ]
    lines += _summary("those in close-fitting clothes", close)
    return [*lines, *_summary("they in underwear", [by_person[each.person] for each in close])]


def label_lines(unsaid: Sequence[DressedScore]) -> list[str]:
    """Mean intersection over union by class, over pictures that show it."""
    told = [each.overlaps for each in unsaid if each.overlaps]
    if not told:
        return []
    lines = ["", f"{'labels, intersection over union':{WIDEST_CLASS}s}pictures"]
    for name in CLASSES:
        shares = [share for each in told if (share := each[name]) is not None]
        if shares:
            mean = f"{np.mean(shares):.2f}{plus_minus(shares, 2)}"
            lines.append(
                f"{name:{WIDEST_CLASS}s}{len(shares):8d}{mean:>14s}  least {min(shares):.2f}"
            )
    return lines


def _case_line(each: DressedScore) -> str:
    scored = each.scored
    line = f"{scored.name:40s}{each.said:14s}"
    for key in KEYS:
        error = scored.standard_errors.get(key)
        told = "given" if error is None else f"{scored.errors[key]:+.1f} ({error:.1f})"
        line += f"{told:>13s}"
    line += f"{scored.vertex_mm or np.nan:11.1f}{scored.joint_mm:10.1f}"
    return f"{line}  {each.outfit}{'  failed' if scored.failed else ''}"


def _columns(title: str) -> str:
    columns = "".join(f"{f'{name} {unit} (bias)':>26s}" for name, _, unit in MEASUREMENTS)
    return f"{title:{WIDEST_CLASS}s}{'n':>3s}{columns}"


def _summary_heading(title: str) -> list[str]:
    return [f"{_columns(title)}{f'{LEVEL} % hold':>14s}"]


def _summary(title: str, scored: Sequence[Scored]) -> list[str]:
    """Mean absolute errors and bias; below, the median width of the intervals, end to end."""
    if not scored:
        return []
    line, widths = (
        f"{title:{WIDEST_CLASS}s}{len(scored):3d}",
        f"{'  median width':{WIDEST_CLASS + 3}s}",
    )
    for key in KEYS:
        known = [each.standard_errors[key] for each in scored if key in each.standard_errors]
        errors = _errors([each.errors[key] for each in scored]) if known else "-"
        line += f"{errors:>26s}"
        width = f"{2.0 * DEVIATIONS * np.median(known):.1f}" if known else "-"
        widths += f"{width:>26s}"
    held_by_person = [held(each, KEYS, DEVIATIONS) for each in scored]
    shares = [100.0 * float(np.mean(each)) for each in held_by_person]
    share = 100.0 * np.mean([yes for each in held_by_person for yes in each])
    return [f"{line}{f'{share:.0f}{plus_minus(shares, 0)} %':>14s}", widths]


def _errors(errors: Sequence[float]) -> str:
    away, bias = np.abs(errors), np.array(errors)
    mean = f"{away.mean():.1f}{plus_minus(away, 1)}"
    return f"{mean} ({bias.mean():+.1f}{plus_minus(bias, 1)})"


def plus_minus(values: Sequence[float] | np.ndarray, places: int) -> str:
    """The standard error of a mean; nothing of one value."""
    if len(values) < 2:
        return ""
    return f" ±{np.std(values, ddof=1) / np.sqrt(len(values)):.{places}f}"
