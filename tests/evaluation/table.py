"""The suite's figures as text."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from fitter.request import Cues
from tests.evaluation.shape_limit import ShapeLimit
from tests.evaluation.suite import Scored

MEASUREMENTS = (
    ("chest", "chest_girth", "cm"),
    ("waist", "waist_girth_navel", "cm"),
    ("hip", "hip_girth", "cm"),
    ("weight", "weight", "kg"),
)


def case_lines(scored: Sequence[Scored]) -> list[str]:
    """One line a fit: signed errors."""
    heading = f"{'case':24s}{'cues':5s}" + "".join(
        f"{f'{name} {unit}':>10s}" for name, _, unit in MEASUREMENTS
    )
    heading += (
        f"{'vertex mm':>11s}{'joint mm':>10s}{'overlap':>9s}{'mask':>7s}{'light°':>8s}{'s':>6s}"
    )
    return [heading, *(_case_line(each) for each in scored)]


def summary_lines(scored: Sequence[Scored]) -> list[str]:
    """Mean absolute, median and 95th percentile of the errors, SE and SES side by side."""
    figures: list[tuple[str, Callable[[Scored], float]]] = [
        (f"{name} [{unit}]", lambda each, key=key: abs(each.errors[key]))
        for name, key, unit in MEASUREMENTS
    ]
    figures += [
        ("vertices [mm]", lambda each: each.vertex_mm),
        ("joints [mm]", lambda each: each.joint_mm),
        ("1 - overlap [%]", lambda each: 100.0 * (1.0 - each.overlap)),
        ("seconds", lambda each: each.seconds),
    ]
    lines = [
        f"{'':18s}" + "".join(f"{f'{cues} mean':>11s}{'median':>8s}{'p95':>8s}" for cues in Cues)
    ]
    for name, figure in figures:
        line = f"{name:18s}"
        for cues in Cues:
            values = [figure(each) for each in scored if each.cues is cues]
            line += (
                f"{np.mean(values):11.2f}{np.median(values):8.2f}{np.percentile(values, 95):8.2f}"
                if values
                else f"{'-':>27s}"
            )
        lines.append(line)
    lights = [each.light_degrees for each in scored if each.light_degrees is not None]
    if lights:
        lines.append(
            f"light direction, SES: mean {np.mean(lights):.1f}°, largest {max(lights):.1f}°"
        )
    return lines


def limit_lines(limits: Mapping[str, ShapeLimit]) -> list[str]:
    """What the shape space leaves of each person, by name."""
    columns = "".join(f"{f'{name} {unit}':>10s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{'person':24s}{columns}{'rest mm':>9s}{'|shape|':>9s}"]
    for name, limit in limits.items():
        errors = "".join(f"{limit.errors[key]:+10.1f}" for _, key, _ in MEASUREMENTS)
        lines.append(f"{name:24s}{errors}{limit.rest_mm:9.1f}{limit.length:9.1f}")
    return lines


def _case_line(scored: Scored) -> str:
    line = f"{scored.case.name:24s}{scored.cues.value:5s}"
    line += "".join(f"{scored.errors[key]:+10.1f}" for _, key, _ in MEASUREMENTS)
    line += f"{scored.vertex_mm:11.1f}{scored.joint_mm:10.1f}"
    line += f"{scored.overlap:9.3f}{scored.mask_overlap:7.3f}"
    light = "-" if scored.light_degrees is None else f"{scored.light_degrees:.1f}"
    return f"{line}{light:>8s}{scored.seconds:6.1f}"
