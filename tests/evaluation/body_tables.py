"""Where fitted bodies err, as text: along the trunk, in distance, by the people's build."""

from collections.abc import Mapping, Sequence

import numpy as np

from fitter.vocabulary.choices import Cues
from tests.evaluation.joint_figures import PAIRS
from tests.evaluation.scoring import Scored
from tests.evaluation.table import MEASUREMENTS
from tests.evaluation.trunk_sections import LEVELS

CENTIMETRES = 100.0

BMI_CLASSES: Mapping[str, tuple[float, float]] = {
    "< 18.5": (0.0, 18.5),
    "18.5-25": (18.5, 25.0),
    "25-30": (25.0, 30.0),
    "30-35": (30.0, 35.0),
    ">= 35": (35.0, np.inf),
}
"""Lower bounds count, upper ones do not, as the WHO draws them (kilograms per square metre)."""


def bmi_class(bmi: float) -> str:
    """The name of a body mass index's class."""
    return next(name for name, (low, high) in BMI_CLASSES.items() if low <= bmi < high)


def bmi_lines(scored: Sequence[Scored]) -> list[str]:
    """Mean absolute errors, in brackets their mean, by class of body mass index."""
    columns = "".join(f"{f'{name} {unit}':>16s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{'BMI':10s}{'cues':5s}{'fits':>5s}{columns}"]
    for name in BMI_CLASSES:
        for cues in Cues:
            these = [each for each in scored if each.cues is cues and bmi_class(each.bmi) == name]
            if these:
                line = f"{name:10s}{cues.value:5s}{len(these):5d}"
                for _, key, _ in MEASUREMENTS:
                    errors = np.array([each.errors[key] for each in these])
                    line += f"{f'{np.abs(errors).mean():.2f} ({errors.mean():+.2f})':>16s}"
                lines.append(line)
    return lines


def trunk_lines(scored: Sequence[Scored]) -> list[str]:
    """Fitted minus true breadths and depths by height, centimetres: bias and mean absolute."""
    heading = "trunk [cm], by height over the floor as a share of the body's"
    lines = [heading, f"{'fitted minus true':26s}" + "".join(f"{each:8.2f}" for each in LEVELS)]
    for cues in Cues:
        trunks = [each.trunk for each in scored if each.cues is cues]
        if not trunks:
            continue
        for name, errors in (
            ("breadth", np.array([each.breadth_m for each in trunks])),
            ("depth", np.array([each.depth_m for each in trunks])),
        ):
            bias = CENTIMETRES * errors.mean(axis=0)
            away = CENTIMETRES * np.abs(errors).mean(axis=0)
            lines += [
                f"{f'{cues} {name} bias':26s}" + "".join(f"{each:+8.2f}" for each in bias),
                f"{f'{cues} {name} mean absolute':26s}" + "".join(f"{each:8.2f}" for each in away),
            ]
    return lines


def distance_lines(scored: Sequence[Scored]) -> list[str]:
    """Fitted minus true distance from the camera of pairs of joints, centimetres.

    Where the focal length is known, because a wrong one is most of the error elsewhere.
    """
    known = [each for each in scored if each.focal_length_known]
    of = f"{len({each.name for each in known})} of {len({each.name for each in scored})} pictures"
    lines = [
        f"distance [cm] in {of} whose focal length is known",
        f"{'fitted minus true':26s}" + "".join(f"{pair:>11s}" for pair in PAIRS),
    ]
    for cues in Cues:
        these = [each.distances_m for each in known if each.cues is cues]
        if not these:
            continue
        errors = CENTIMETRES * np.array([[each[pair] for pair in PAIRS] for each in these])
        for name, values, sign in (
            ("bias", errors.mean(axis=0), "+"),
            ("standard deviation", errors.std(axis=0), ""),
            ("mean absolute", np.abs(errors).mean(axis=0), ""),
        ):
            lines.append(f"{f'{cues} {name}':26s}" + "".join(f"{v:{sign}11.2f}" for v in values))
    return lines
