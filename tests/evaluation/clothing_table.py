"""People in loose clothes: what saying so changes, as text."""

from collections.abc import Mapping, Sequence

import numpy as np

from fitter.request import Clothing
from tests.evaluation.scoring import Scored
from tests.evaluation.table import INTERVALS, MEASUREMENTS

LEVEL, DEVIATIONS = INTERVALS[1]


def clothing_lines(scored: Sequence[tuple[Clothing, Scored]]) -> list[str]:
    """Signed errors and standard errors of each picture, each below the other; then
    mean absolute errors (medians) and how many intervals hold the truth."""
    heading = f"{'case':40s}{'clothing':9s}"
    heading += "".join(f"{f'{name} {unit}':>13s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{heading}{'vertex mm':>11s}{'joint mm':>10s}"]
    by_case = sorted(scored, key=lambda pair: pair[1].name)
    for clothing, each in by_case:
        line = f"{each.name:40s}{clothing.value:9s}"
        for _, key, _ in MEASUREMENTS:
            line += f"{f'{each.errors[key]:+.1f} ({each.standard_errors[key]:.1f})':>13s}"
        line += f"{each.vertex_mm or np.nan:11.1f}{each.joint_mm:10.1f}"
        lines.append(f"{line}{'  failed' if each.failed else ''}")
    for clothing in Clothing:
        these = [each for said, each in scored if said is clothing]
        line = f"{'mean absolute (median)':40s}{clothing.value:9s}"
        for _, key, _ in MEASUREMENTS:
            away = np.abs([each.errors[key] for each in these])
            line += f"{f'{away.mean():.1f} ({np.median(away):.1f})':>13s}"
        line += f"{np.mean([each.vertex_mm or np.nan for each in these]):11.1f}"
        line += f"{np.mean([each.joint_mm for each in these]):10.1f}"
        held = [
            abs(each.errors[key]) <= DEVIATIONS * each.standard_errors[key]
            for each in these
            for _, key, _ in MEASUREMENTS
        ]
        lines.append(f"{line}  {LEVEL} % hold {sum(held)}/{len(held)}")
        line = f"{'bias (half width)':40s}{clothing.value:9s}"
        for _, key, _ in MEASUREMENTS:
            bias = np.mean([each.errors[key] for each in these])
            half = DEVIATIONS * np.mean([each.standard_errors[key] for each in these])
            line += f"{f'{bias:+.1f} ({half:.1f})':>13s}"
        lines.append(line)
    return lines


def null_lines(nulls: Mapping[str, Sequence[Mapping[str, float]]]) -> list[str]:
    """Mean absolute errors (bias) of what is said without a picture, by what is known."""
    lines: list[str] = []
    for title, errors in nulls.items():
        line = f"{title:49s}"
        for _, key, _ in MEASUREMENTS:
            off = np.array([each[key] for each in errors])
            line += f"{f'{np.abs(off).mean():.1f} ({off.mean():+.1f})':>13s}"
        lines.append(line)
    return lines
