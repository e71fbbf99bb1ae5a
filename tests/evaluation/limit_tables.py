"""Figures of the shape space, of outlines and of several pictures as text."""

from collections.abc import Mapping, Sequence

import numpy as np

from tests.evaluation.several import SeveralPictures
from tests.evaluation.shape_limit import ShapeLimit
from tests.evaluation.table import INTERVALS, MEASUREMENTS


def limit_lines(limits: Mapping[str, ShapeLimit]) -> list[str]:
    """What the shape space leaves of each person, by name."""
    columns = "".join(f"{f'{name} {unit}':>10s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{'person':28s}{columns}{'rest mm':>9s}{'|shape|':>9s}"]
    for name, limit in limits.items():
        errors = "".join(f"{limit.errors[key]:+10.1f}" for _, key, _ in MEASUREMENTS)
        lines.append(f"{name:28s}{errors}{limit.rest_mm:9.1f}{limit.length:9.1f}")
    return lines


def outline_lines(limits: Mapping[str, Mapping[str, Mapping[str, float]]]) -> list[str]:
    """What exactly known outlines leave of each gender's measurements, mean absolute errors."""
    columns = "".join(f"{f'{name} {unit}':>11s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{'outline from':28s}{columns}"]
    for gender, views in limits.items():
        for view, errors in views.items():
            values = "".join(f"{errors[key]:11.2f}" for _, key, _ in MEASUREMENTS)
            lines.append(f"{f'{view}, {gender}':28s}{values}")
    return lines


def several_lines(found: Sequence[SeveralPictures]) -> list[str]:
    """Mean (median) errors, mean standard errors and coverage by the number of pictures.

    The poses are those in the pictures, by their own fits and with the shape in common; limbs are
    wrong in so many of them.
    """
    heading = f"{'pictures':10s}{'choices':>8s}" + "".join(
        f"{f'{name} {unit}':>16s}{'s.e.':>6s}" for name, _, unit in MEASUREMENTS
    )
    lines = [f"{heading}{'95 % hold':>11s}{'joints mm':>14s}{'limbs wrong':>16s}"]
    for count in sorted({each.pictures for each in found}):
        these = [each for each in found if each.pictures == count]
        line = f"{count:<10d}{len(these):8d}"
        within: list[bool] = []
        for _, key, _ in MEASUREMENTS:
            away = np.abs([each.errors[key] for each in these])
            certain = np.array([each.standard_errors[key] for each in these])
            line += f"{f'{away.mean():.2f} ({np.median(away):.2f})':>16s}{certain.mean():6.2f}"
            within += list(away <= INTERVALS[1][1] * certain)
        line += f"{100.0 * np.mean(within):10.0f}%"
        before = [pose for each in these for pose in each.before]
        after = [pose for each in these for pose in each.after]
        joints = [np.mean([pose.joint_mm for pose in poses]) for poses in (before, after)]
        wrong = [sum(pose.wrong_limbs > 0 for pose in poses) for poses in (before, after)]
        line += f"{f'{joints[0]:.1f} > {joints[1]:.1f}':>14s}"
        lines.append(line + f"{f'{wrong[0]} > {wrong[1]} of {len(after)}':>16s}")
    return lines
