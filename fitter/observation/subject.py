"""Checks of what the caller says about the person and the light."""

import math
from collections.abc import Mapping

from fitter.errors import InvalidInputError
from fitter.request import LightGuess, Person
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import LEAST_HEIGHT_M, MOST_HEIGHT_M, STATURE
from fitter.vocabulary.remarks import Note, Remark, assumed

MEAN_HEIGHT_M: Mapping[Gender, float] = {Gender.FEMALE: 1.65, Gender.MALE: 1.82}
"""Section 4: the heights assumed for people whose height is not known, as in paintings."""


def check_person(person: Person) -> None:
    """Refuse an impossible height or measurement.

    Raises
    ------
    InvalidInputError
        ``out-of-range``, ``two-heights`` or ``measurement-invalid``.
    """
    check_height(person.height_m)
    if person.height_m is not None and STATURE in person.measurements:
        raise InvalidInputError(
            code="two-heights",
            field="height_m",
            reason=f"Both height_m and measurements.{STATURE} are given.",
            remedy="Send one of the two.",
        )
    for name, known in person.measurements.items():
        if not (0.0 < known.value < math.inf and 0.0 <= known.standard_error < math.inf):
            raise InvalidInputError(
                code="measurement-invalid",
                field=known.field_of(name),
                reason="A value is positive and finite, a standard error finite and not negative.",
                remedy="Correct it, or leave the measurement out.",
            )


def check_light(guess: LightGuess) -> None:
    """Refuse an impossible first light.

    Raises
    ------
    InvalidInputError
        ``light-invalid``.
    """
    for name, value in (
        ("azimuth", guess.azimuth),
        ("elevation", guess.elevation),
        ("distance", guess.distance),
    ):
        if value is not None and not math.isfinite(value):
            raise InvalidInputError(
                code="light-invalid",
                field=f"light.{name}",
                reason="The value is not a finite number.",
                remedy="Leave it out to have it estimated.",
            )
    if guess.distance is not None and guess.distance <= 0.0:
        raise InvalidInputError(
            code="light-invalid",
            field="light.distance",
            reason="A light's distance is positive.",
            remedy="Give metres from the person, or leave it out.",
        )


def check_height(height_m: float | None) -> None:
    """Refuse an impossible height.

    Raises
    ------
    InvalidInputError
        ``out-of-range``.
    """
    if height_m is not None and not LEAST_HEIGHT_M <= height_m <= MOST_HEIGHT_M:
        raise InvalidInputError(
            code="out-of-range",
            field="height_m",
            reason=(
                f"A height of {height_m:g} m is outside {LEAST_HEIGHT_M:g} to {MOST_HEIGHT_M:g} m, "
                "and the bodies are those of grown-up people."
            ),
            remedy="Give the standing height of a grown-up person in metres.",
        )


def subject_height(person: Person) -> tuple[float, tuple[Remark, ...]]:
    """The caller's height, or the mean of the gender together with the assumption."""
    if person.height_m is not None:
        return person.height_m, ()
    mean = MEAN_HEIGHT_M[person.gender]
    said = assumed(
        Note.HEIGHT_ASSUMED,
        f"No height was given; the mean of the gender, {mean:.2f} m, was taken.",
        where=("height_m",),
    )
    return mean, (said,)
