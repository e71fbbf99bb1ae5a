"""The chain from mesh to fit as text."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from fitter.vocabulary.choices import Cues
from tests.evaluation.body_tables import CENTIMETRES
from tests.evaluation.chain import Link
from tests.evaluation.table import MEASUREMENTS
from tests.evaluation.trunk_sections import LEVELS


def chain_case_lines(links: Sequence[Link]) -> list[str]:
    """Signed errors of every picture on every rung, pictures' by SES."""
    heading = f"{'case':8s}{'told':24s}" + "".join(
        f"{f'{name} {unit}':>11s}" for name, _, unit in MEASUREMENTS
    )
    heading += "".join(f"{name:>9s}" for name in ("breadth", "depth", "hips cm", "stature"))
    lines = [f"{heading}{'joint mm':>10s}{'trunk mm':>10s}"]
    for each in links:
        if each.cues is Cues.SE:
            continue
        line = f"{each.picture:8s}{each.rung:24s}"
        line += "".join(f"{each.errors[key]:+11.1f}" for _, key, _ in MEASUREMENTS)
        for extents in (each.trunk.breadth_m, each.trunk.depth_m):
            line += f"{CENTIMETRES * extents.mean():+9.1f}"
        line += "        -" if each.hips_m is None else f"{CENTIMETRES * each.hips_m:+9.1f}"
        line += "        -" if each.stature_cm is None else f"{each.stature_cm:+9.1f}"
        line += f"{each.joint_mm:10.1f}"
        line += "         -" if each.trunk_mm is None else f"{each.trunk_mm:10.1f}"
        lines.append(line)
    return lines


def chain_lines(links: Sequence[Link]) -> list[str]:
    """Mean absolute errors, in brackets their mean, by rung; then the trunk's, by height.

    Hips are their distance from the camera, where the focal length is known; the trunk in
    millimetres is the root mean square distance of the mesh from ours. The stature is given to
    fits, and found on the mesh.
    """
    rungs = list(dict.fromkeys((each.rung, each.cues) for each in links))
    of = {rung: [each for each in links if (each.rung, each.cues) == rung] for rung in rungs}
    names = [f"{name} {unit}" for name, _, unit in MEASUREMENTS] + ["hips cm", "stature cm"]
    heading = f"{'told':24s}{'cues':5s}" + "".join(f"{name:>16s}" for name in names)
    lines = ["", f"{heading}{'joint mm':>10s}{'trunk mm':>10s}"]
    for (rung, cues), these in of.items():
        line = f"{rung:24s}{cues or '-':5s}"
        for _, key, _ in MEASUREMENTS:
            line += f"{_absolute_and_bias([each.errors[key] for each in these]):>16s}"
        hips = [CENTIMETRES * each.hips_m for each in these if each.hips_m is not None]
        away = [each.trunk_mm for each in these if each.trunk_mm is not None]
        statures = [each.stature_cm for each in these if each.stature_cm is not None]
        line += f"{_absolute_and_bias(hips):>16s}{_absolute_and_bias(statures):>16s}"
        line += f"{np.mean([each.joint_mm for each in these]):10.1f}"
        lines.append(line + (f"{np.mean(away):10.1f}" if away else f"{'-':>10s}"))
    for name in ("breadth", "depth"):
        heading = "".join(f"{level:15.2f}" for level in LEVELS)
        lines += ["", f"{f'{name} [cm] at':29s}{heading}"]
        for (rung, cues), these in of.items():
            errors = CENTIMETRES * np.array([getattr(each.trunk, f"{name}_m") for each in these])
            line = "".join(f"{_absolute_and_bias(column):>15s}" for column in errors.T)
            lines.append(f"{rung:24s}{cues or '-':5s}{line}")
    return lines


def _absolute_and_bias(errors: Sequence[float] | Float[np.ndarray, " k"]) -> str:
    if not len(errors):
        return "-"
    return f"{np.abs(errors).mean():.2f} ({np.mean(errors):+.2f})"
