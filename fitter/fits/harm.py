"""How much less sure measurements are for what harms a picture: one table, by finding.

For light, blur and size the factors are the root mean squares of errors over standard errors on
spoilt pictures of 14 people of the tuning halves, 84 fits with shading: they make them one again.
So are those of eleven people who are cut off at shins, thighs, hips or waist, 42 fits: the worst of
the four counts. A near camera has that by which errors grew in two pictures (MEASURING.md).
What is not in the table cost nothing measurable (a rolled camera, arms at the trunk, too much
light), is in the fit's own errors already (loose clothes), or cannot be put in figures (another
person was taken).
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from fitter.capture.finding import Code, Finding
from fitter.measurement.quantity import Measurement
from fitter.vocabulary.measurements import WEIGHT
from fitter.vocabulary.outcomes import Severity


@dataclass(frozen=True, slots=True, kw_only=True)
class Harm:
    """Factors of standard errors.

    Attributes
    ----------
    chest
        Girths, breadths and depths from the shoulders to the bust.
    waist
        The same from the bust to the hips.
    hip
        The same of seat and legs.
    weight
        Of the weight.
    """

    chest: float = 1.0
    waist: float = 1.0
    hip: float = 1.0
    weight: float = 1.0


_SMALL: Final = Harm(chest=1.1, waist=1.6, hip=1.1, weight=1.6)

HARM: Final[Mapping[Code, Harm]] = {
    Code.BLURRED: Harm(waist=1.7, hip=1.2, weight=1.4),
    Code.TOO_DARK: Harm(chest=1.2, waist=1.8, hip=1.3, weight=1.7),
    Code.PERSON_TOO_SMALL: _SMALL,
    Code.PICTURE_TOO_SMALL: _SMALL,
    Code.CAMERA_TOO_NEAR: Harm(chest=1.6, waist=1.2, hip=1.2, weight=1.4),
    # Of 12 people in clothes and 12 in underwear, in pictures without colours.
    Code.SKIN_NOT_FOUND: Harm(waist=1.3, hip=1.2, weight=1.7),
    Code.CUT_OFF: Harm(chest=1.4, waist=1.3, hip=1.2, weight=1.5),
    # What is bent hides what is measured. There are no figures: no less than the others.
    Code.NOT_STANDING: Harm(chest=1.5, waist=2.0, hip=2.0, weight=1.5),
}

_CHEST: Final = frozenset({
    "upper_chest_girth", "chest_girth", "under_bust_girth", "armscye_girth", "upper_arm_girth",
    "chest_breadth", "chest_depth", "cross_back", "cross_front", "bust_point_width",
})  # fmt: skip
_WAIST: Final = frozenset({
    "waist_girth_smallest", "waist_girth_navel", "abdomen_girth", "waist_breadth", "waist_depth",
    "trunk_girth",
})  # fmt: skip
_HIP: Final = frozenset({
    "high_hip_girth", "hip_girth", "hip_breadth", "hip_depth", "crotch_length", "thigh_girth",
    "mid_thigh_girth", "lower_thigh_girth", "knee_girth", "calf_girth", "ankle_girth",
})  # fmt: skip


def widened(
    measurements: Sequence[Measurement],
    pictures: Sequence[Sequence[Finding]],
    given: Collection[str],
) -> tuple[Measurement, ...]:
    """Measurements with the standard errors that the findings leave.

    Of one picture's findings the worst factor counts, of several pictures' the least: what one
    does not show another may.
    """
    return tuple(
        each
        if each.standard_error is None or each.name in given
        else replace(each, standard_error=each.standard_error * _factor(each.name, pictures))
        for each in measurements
    )


def _factor(measurement: str, pictures: Sequence[Sequence[Finding]]) -> float:
    return min(
        (
            max(
                (
                    _of(HARM.get(found.code, Harm()), measurement)
                    for found in findings
                    if found.severity is Severity.HARMS
                ),
                default=1.0,
            )
            for findings in pictures
        ),
        default=1.0,
    )


def _of(harm: Harm, measurement: str) -> float:
    if measurement == WEIGHT:
        return harm.weight
    for group, factor in ((_CHEST, harm.chest), (_WAIST, harm.waist), (_HIP, harm.hip)):
        if measurement in group:
            return factor
    return 1.0
