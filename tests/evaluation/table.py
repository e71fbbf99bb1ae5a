"""The suite's figures as text."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from fitter.request import Cues
from tests.evaluation.several import SeveralPictures
from tests.evaluation.shape_limit import ShapeLimit
from tests.evaluation.suite import Scored

MEASUREMENTS = (
    ("chest", "chest_girth", "cm"),
    ("waist", "waist_girth_navel", "cm"),
    ("hip", "hip_girth", "cm"),
    ("weight", "weight", "kg"),
)

INTERVALS = ((68, 1.0), (95, 1.96))
"""Per cent of a normal distribution within so many standard errors."""


def case_lines(scored: Sequence[Scored]) -> list[str]:
    """One line a fit: signed errors."""
    heading = f"{'case':36s}{'cues':5s}" + "".join(
        f"{f'{name} {unit}':>10s}" for name, _, unit in MEASUREMENTS
    )
    heading += (
        f"{'vertex mm':>11s}{'joint mm':>10s}{'overlap':>9s}{'mask':>7s}{'light°':>8s}{'s':>6s}"
    )
    return [heading, *(_case_line(each) for each in scored)]


def summary_lines(scored: Sequence[Scored]) -> list[str]:
    """Mean absolute, median and 95th percentile of the errors, SE and SES side by side."""
    figures: list[tuple[str, Callable[[Scored], float | None]]] = [
        (f"{name} [{unit}]", lambda each, key=key: abs(each.errors[key]))
        for name, key, unit in MEASUREMENTS
    ]
    figures += [
        ("vertices [mm]", lambda each: each.vertex_mm),
        ("joints [mm]", lambda each: each.joint_mm),
        ("1 - overlap [%]", lambda each: 100.0 * (1.0 - each.overlap)),
        ("light [degrees]", lambda each: each.light_degrees),
        ("seconds", lambda each: each.seconds),
    ]
    lines = [
        f"{'':18s}" + "".join(f"{f'{cues} mean':>11s}{'median':>8s}{'p95':>8s}" for cues in Cues)
    ]
    for name, figure in figures:
        line = f"{name:18s}"
        for cues in Cues:
            values = [figure(each) for each in scored if each.cues is cues]
            known = [value for value in values if value is not None]
            line += (
                f"{np.mean(known):11.2f}{np.median(known):8.2f}{np.percentile(known, 95):8.2f}"
                if known
                else f"{'-':>11s}{'-':>8s}{'-':>8s}"
            )
        lines.append(line)
    lines += [
        f"{name:18s}" + "".join(f"{_share(values[cues]):>11s}{'':16s}" for cues in Cues).rstrip()
        for name, values in _shares(scored)
    ]
    lines.append(f"{'SES waist better':18s}{'':27s}{_share(_waist_better(scored)):>11s}")
    return lines


def worst_lines(scored: Sequence[Scored], count: int = 5) -> list[str]:
    """The fits by SES whose girths are farthest from the truth on the mean."""
    girths = [key for _, key, unit in MEASUREMENTS if unit == "cm"]

    def distance(each: Scored) -> float:
        return float(np.mean([abs(each.errors[key]) for key in girths]))

    shaded = sorted((each for each in scored if each.cues is Cues.SES), key=distance)
    return ["worst", *(_case_line(each) for each in shaded[::-1][:count])] if shaded else []


def _shares(scored: Sequence[Scored]) -> list[tuple[str, dict[Cues, list[bool]]]]:
    """Yes or no of every fit: whether intervals hold the truth, whether the pose failed."""
    of = {cues: [each for each in scored if each.cues is cues] for cues in Cues}
    keys = [key for _, key, _ in MEASUREMENTS]
    rows = [
        (
            f"truth in {level} %",
            {cues: [yes for each in of[cues] for yes in held(each, keys, z)] for cues in Cues},
        )
        for level, z in INTERVALS
    ]
    rows += [
        (
            f"  {name} in {level} %",
            {cues: [yes for each in of[cues] for yes in held(each, [key], z)] for cues in Cues},
        )
        for name, key, _ in MEASUREMENTS
        for level, z in INTERVALS
    ]
    rows.append(("failures", {cues: [each.failed for each in of[cues]] for cues in Cues}))
    return rows


def held(scored: Scored, keys: Sequence[str], deviations: float) -> list[bool]:
    """Whether intervals of so many standard errors hold the true measurements."""
    return [
        abs(scored.errors[key]) <= deviations * scored.standard_errors[key]
        for key in keys
        if key in scored.standard_errors
    ]


def _waist_better(scored: Sequence[Scored]) -> list[bool]:
    """For each picture fitted with both: whether the waist of SES is nearer to the truth."""
    waist = {(each.case.name, each.cues): abs(each.errors["waist_girth_navel"]) for each in scored}
    return [
        waist[name, Cues.SES] < error
        for (name, cues), error in waist.items()
        if cues is Cues.SE and (name, Cues.SES) in waist
    ]


def _share(yes: Sequence[bool]) -> str:
    return f"{sum(yes)}/{len(yes)} {np.mean(yes):4.0%}" if yes else "-"


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


def _case_line(scored: Scored) -> str:
    line = f"{scored.case.name:36s}{scored.cues.value:5s}"
    line += "".join(f"{scored.errors[key]:+10.1f}" for _, key, _ in MEASUREMENTS)
    line += f"{scored.vertex_mm:11.1f}{scored.joint_mm:10.1f}"
    line += f"{scored.overlap:9.3f}{scored.mask_overlap:7.3f}"
    light = "-" if scored.light_degrees is None else f"{scored.light_degrees:.1f}"
    failed = " failed " + " ".join(scored.wrong_limbs) if scored.failed else ""
    return f"{line}{light:>8s}{scored.seconds:6.1f}{failed}".rstrip()


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
