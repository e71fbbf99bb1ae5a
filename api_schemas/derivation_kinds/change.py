"""A comparison of two fits in time: what is asked for, and what comes of it."""

from typing import Annotated, Literal
from uuid import UUID

from pydantic import AfterValidator, Field

from api_schemas.base import WireModel, refusal
from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles
from api_schemas.known import MeasurementName
from api_schemas.measurement_names import unknown_name_remedy
from api_schemas.results import FitWarning
from fitter.vocabulary.measurements import MEASUREMENT_UNITS


def _known_and_each_once(names: tuple[str, ...] | None) -> tuple[str, ...] | None:
    for place, name in enumerate(names or ()):
        field = f"measurements.{place}"
        if name not in MEASUREMENT_UNITS:
            raise refusal(
                code="unknown-value",
                reason=f"There is no measurement '{name}'.",
                remedy=unknown_name_remedy(name),
                field=field,
            )
        if name in (names or ())[:place]:
            raise refusal(
                code="repeated",
                reason=f"The measurement '{name}' is named twice.",
                remedy="Name it once.",
                field=field,
            )
    return names


class ChangeOptions(DerivationOptions):
    """What changed since an earlier fit of the same person, as far as it can be told.

    A difference is called a change where it is larger than both fits' errors let expect. Errors of
    two fits of one person are taken to be correlated by 0.4, as they are between pictures of one
    day, and not at all where a measurement was given; much more is shared by pictures that were
    taken alike, so that too little is called a change rather than too much. Holm's procedure
    corrects for the number of measurements: where nothing changed, at most one comparison in twenty
    calls anything a change. What both fits were given exactly, say a weight, is compared exactly.
    """

    kind: Literal["change"]
    since: UUID = Field(
        description=(
            "The earlier fit, one that has succeeded, of the same person and gender. What is made "
            "of two fits is erased with either, and expires with the first."
        )
    )
    measurements: Annotated[
        tuple[MeasurementName, ...] | None, AfterValidator(_known_and_each_once)
    ] = Field(
        default=None,
        min_length=1,
        description=(
            "Compare these alone; null compares all. The fewer there are, the smaller a difference "
            "may be that is called a change: choose them before you have seen the differences."
        ),
        examples=[["waist_girth_navel", "weight"]],
    )


class MeasurementChange(WireModel):
    """How one measurement differs; ``difference`` is ``after`` minus ``before``."""

    name: str
    unit: str
    before: float = Field(description="Of the earlier fit.")
    after: float = Field(description="Of this fit.")
    difference: float
    standard_error: float = Field(
        description="Of the difference; zero where both were given exactly."
    )
    shared_error: float = Field(description="Correlation of both errors, as assumed.")
    p_value: float | None = Field(
        description=(
            "Probability of so large a difference where nothing changed, corrected for all that "
            "were compared; null where there is nothing to test."
        )
    )
    least: float = Field(description="What would be called a change, were it the only one.")
    is_change: bool


class ChangeResult(DerivedFiles):
    """The differences, and ``changes.csv``, the same as a table.

    Warnings: ``heights-differ`` where the fits were told different heights, which all girths
    follow.
    """

    kind: Literal["change"] = "change"
    since: UUID
    significance: float = Field(
        description="Probability of calling anything a change where nothing changed, at most."
    )
    changes: tuple[MeasurementChange, ...]
    warnings: tuple[FitWarning, ...]
