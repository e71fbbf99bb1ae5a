"""Errors by the people's build, as text."""

from collections.abc import Mapping, Sequence

import numpy as np

from fitter.vocabulary.choices import Cues
from tests.accuracy.scoring import Scored
from tests.accuracy.table import MEASUREMENTS

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
