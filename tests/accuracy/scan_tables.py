"""What scans are worth, as text: errors by views, and the worst of them."""

from collections.abc import Iterator, Sequence

import numpy as np

from fitter.vocabulary.choices import Clothing
from tests.accuracy.clothing_table import plus_minus
from tests.accuracy.scans import Scanned, Views
from tests.accuracy.table import INTERVALS, MEASUREMENTS

WORST = 8

WIDTHS = 2.0 * INTERVALS[-1][1]
"""Of a 95 % interval from end to end, in standard errors."""


def scan_lines(found: Sequence[Scanned]) -> list[str]:
    """Mean absolute errors with their standard errors over people, in brackets their mean, by
    views, without the weight and with it.

    Beside each the median width of its 95 % interval; then the share of truths in these intervals,
    of what was not given, the joints' mean distance and the overlap with the true body.
    """
    columns = "".join(f"{f'{name} {unit}':>21s}{'width':>6s}" for name, _, unit in MEASUREMENTS)
    heading = f"{'views':24s}{'people':>7s}{columns}"
    lines = [f"{heading}{'95 % hold':>11s}{'joints mm':>11s}{'overlap':>9s}"]
    for name, these in _kinds(found):
        line = f"{name:24s}{len(these):7d}"
        held: list[bool] = []
        for _, key, _ in MEASUREMENTS:
            errors = np.array([each.errors[key] for each in these])
            known = [each for each in these if key in each.standard_errors]
            away = np.abs(errors)
            spread = plus_minus(away, 2)
            line += f"{f'{away.mean():.2f}{spread} ({errors.mean():+.2f})':>21s}"
            width = WIDTHS * np.median([each.standard_errors[key] for each in known] or [np.nan])
            line += f"{width:6.1f}" if known else f"{'-':>6s}"
            held += [
                abs(each.errors[key]) <= INTERVALS[-1][1] * each.standard_errors[key]
                for each in known
            ]
        line += f"{100.0 * np.mean(held):10.0f}%"
        line += f"{np.mean([each.joint_mm for each in these]):11.1f}"
        lines.append(line + f"{np.mean([each.overlap for each in these]):9.3f}")
    return lines


def worst_scan_lines(found: Sequence[Scanned]) -> list[str]:
    """The people whose girths, from front and side, are farthest from the truth on the mean."""
    girths = [key for _, key, unit in MEASUREMENTS if unit == "cm"]

    def distance(each: Scanned) -> float:
        return float(np.mean([abs(each.errors[key]) for key in girths]))

    unaided = [
        each
        for each in found
        if each.views is Views.BOTH and not each.weight_given and each.clothing is Clothing.AUTO
    ]
    columns = "".join(f"{f'{name} {unit}':>11s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{f'worst, {Views.BOTH}':32s}{columns}{'joints mm':>11s}{'overlap':>9s}"]
    for each in sorted(unaided, key=distance, reverse=True)[:WORST]:
        errors = "".join(f"{each.errors[key]:+11.1f}" for _, key, _ in MEASUREMENTS)
        lines.append(f"{each.person:32s}{errors}{each.joint_mm:11.1f}{each.overlap:9.3f}")
    return lines


def _kinds(found: Sequence[Scanned]) -> Iterator[tuple[str, list[Scanned]]]:
    """Scans of one kind, with the kind's name: nothing said, then the weight, then clothes."""
    told = dict.fromkeys((each.weight_given, each.clothing) for each in found)
    for given, clothing in sorted(told, key=lambda pair: (pair[1] is not Clothing.AUTO, pair)):
        for views in Views:
            these = [
                each
                for each in found
                if each.views is views and each.weight_given is given and each.clothing is clothing
            ]
            said = ["weight"] if given else []
            said += [] if clothing is Clothing.AUTO else [f"said {clothing}"]
            if these:
                yield ", ".join([views.value, *said]), these
