"""The person in the pictures, as a caller describes them: gender, height, weight, measurements."""

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Annotated, Final, Self

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from api_schemas.base import WireModel, refusal
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import (
    LEAST_HEIGHT_M,
    MEASUREMENT_UNITS,
    MOST_HEIGHT_M,
    STATURE,
    WEIGHT,
)

MAX_NAME_LENGTH: Final = 64

_OTHER_UNITS: Final = (
    (0.01, "centimetres"),
    (0.001, "millimetres"),
    (0.3048, "feet"),
    (0.0254, "inches"),
)
_LARGEST_NUMBER: Final = MOST_HEIGHT_M / min(factor for factor, _ in _OTHER_UNITS)
"""A height in the smallest of these units. Beyond it nothing is converted: a whole number of JSON
may be too large for a float."""


_SMALLEST_CHILD_M: Final = 0.4
"""Below it nobody is told to be a child."""


def _metres(value: object) -> object:
    """Name the unit a height was probably given in, or a child's; other faults as usual."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        if _SMALLEST_CHILD_M <= value < LEAST_HEIGHT_M:
            raise refusal(
                code="out-of-range",
                reason=(
                    f"{value:g} m is less than {LEAST_HEIGHT_M:g} m, and the bodies are those of "
                    "grown-up people."
                ),
                remedy="Measure grown-up people alone, and send their standing height in metres.",
            )
        for factor, unit in _OTHER_UNITS if MOST_HEIGHT_M < value <= _LARGEST_NUMBER else ():
            if LEAST_HEIGHT_M <= value * factor <= MOST_HEIGHT_M:
                raise refusal(
                    code="out-of-range",
                    reason=f"{value:g} metres is nobody's height; it looks like {unit}.",
                    remedy=f"Send metres: {value * factor:.4g}.",
                )
    return value


HeightM = Annotated[
    float,
    # First, for behind a validator pydantic writes bounds into schemas that no schema knows.
    Field(ge=LEAST_HEIGHT_M, le=MOST_HEIGHT_M, description="Stature in metres.", examples=[1.68]),
    BeforeValidator(_metres),
]
WeightKg = Annotated[
    float,
    Field(
        gt=0.0,
        le=1_000.0,
        description="Weight in kilograms; says the same as `measurements.weight`.",
        examples=[64.5],
    ),
]
MeasurementName = Annotated[
    str, Field(min_length=1, max_length=MAX_NAME_LENGTH, examples=["waist_girth_navel"])
]
MeasuredValue = Annotated[float, Field(gt=0.0, le=10_000.0, examples=[84.0])]


class UncertainMeasurement(WireModel):
    """A measurement with the standard error it was taken with, both in its unit."""

    value: MeasuredValue
    standard_error: float = Field(ge=0.0, le=1_000.0, examples=[1.5])


def _kind(value: object) -> str:
    return "[uncertain]" if isinstance(value, Mapping | UncertainMeasurement) else "[exact]"


KnownMeasurement = Annotated[
    Annotated[MeasuredValue, Tag("[exact]")] | Annotated[UncertainMeasurement, Tag("[uncertain]")],
    Discriminator(_kind),
]


class Person(WireModel):
    """Gender, height, weight, and whatever else was measured of the person.

    ``measurements`` are by the names, and in the units, of a result's measurements (MEASUREMENTS.md
    lists them). A number is held exactly; with a standard error the body is drawn toward it as far
    as it is certain.
    """

    gender: Gender = Field(description="Which body model is fitted.")
    height_m: HeightM | None = None
    weight_kg: WeightKg | None = None
    measurements: dict[MeasurementName, KnownMeasurement] = Field(
        default_factory=dict[str, float | UncertainMeasurement],
        description=(
            "Girths and lengths in centimetres, by the names of a result's measurements. A number "
            "is held exactly; with a standard error the body is drawn toward it as far as it is "
            "certain."
        ),
        examples=[{"hip_girth": 98, "waist_girth_navel": {"value": 78, "standard_error": 1.5}}],
    )

    @model_validator(mode="after")
    def _said_once(self) -> Self:
        for field, code, name in (
            ("height_m", "two-heights", STATURE),
            ("weight_kg", "two-weights", WEIGHT),
        ):
            if getattr(self, field) is not None and name in self.measurements:
                raise refusal(
                    code=code,
                    reason=f"Both {field} and measurements.{name} are given.",
                    field=field,
                    remedy="Send one of the two.",
                )
        return self


OTHER_WORDS: Final[Mapping[str, str]] = {
    "bust": "chest",
    "seat": "hip",
    "hips": "hip",
    "height": "stature",
    "collar": "neck",
    "sleeve": "arm_length",
    "biceps": "upper_arm",
    "leg": "inseam",
    "mass": "weight",
}
"""Words used in charts, and the words that the names here have in their place."""

_MOST_SUGGESTED: Final = 3


def suggested_names(unknown: str) -> tuple[str, ...]:
    """Names that may have been meant by one that there is not, likeliest first; often none."""
    words = unknown.lower().replace("-", "_").replace(" ", "_").split("_")
    meant = [OTHER_WORDS.get(word, word) for word in words if len(word) > 2]
    alike = get_close_matches("_".join(meant), MEASUREMENT_UNITS, n=_MOST_SUGGESTED, cutoff=0.75)
    holding = [
        name
        for name in MEASUREMENT_UNITS
        if any(word in name for word in meant if word not in ("girth", "length", "breadth"))
    ]
    return tuple(dict.fromkeys([*alike, *holding]))[:_MOST_SUGGESTED]


def unknown_name_remedy(unknown: str) -> str:
    """The remedy for a name that does not exist: what to send in its place."""
    suggested = suggested_names(unknown)
    if suggested:
        return f"Did you mean {' or '.join(suggested)}? MEASUREMENTS.md lists all names."
    return f"Use one of {', '.join(MEASUREMENT_UNITS)}."
