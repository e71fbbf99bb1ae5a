"""One person from several pictures: what is asked for, and what comes of it."""

from typing import Annotated, Final, Literal
from uuid import UUID

from pydantic import AfterValidator, Field

from api_schemas.base import refusal
from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles
from api_schemas.results import FitWarning, Measurement, PictureResult

MOST_OTHER_FITS: Final = 11
"""Twelve pictures of one person in all."""


def _each_once(fits: tuple[UUID, ...]) -> tuple[UUID, ...]:
    if len(set(fits)) == len(fits):
        return fits
    raise refusal(
        code="repeated",
        reason="A fit is named twice.",
        remedy="Name each of the other fits once.",
    )


class CombinedOptions(DerivationOptions):
    """One person from several of their pictures: this fit and others of the same person."""

    kind: Literal["combined"]
    fits: Annotated[tuple[UUID, ...], AfterValidator(_each_once)] = Field(
        min_length=1,
        max_length=MOST_OTHER_FITS,
        description=(
            "Other fits that have succeeded, of the same person, with the same gender, height and "
            "known measurements. What is made of several fits is erased with any of them, and "
            "expires with the first."
        ),
        json_schema_extra={"uniqueItems": True},
    )


class CombinedPicture(PictureResult):
    """The person in one of the pictures, with the shape that all have in common.

    ``outcome``, ``light`` and the others are as in the result of a fit. The picture's files are
    ``body_posed_N.glb`` and ``overlay_N.png`` with ``number`` for N.
    """

    number: int = Field(ge=1, description="1 is this fit, the others follow as they were named.")
    fit_id: UUID


class CombinedResult(DerivedFiles):
    """``body_combined.glb``, in the canonical pose, and ``combined.png``, beside this fit alone.

    ``bodies`` are those of the pictures, each in its own pose and light.
    """

    kind: Literal["combined"] = "combined"
    pictures: int
    shape: tuple[float, ...]
    bodies: tuple[CombinedPicture, ...]
    measurements: tuple[Measurement, ...]
    agreement: float = Field(
        ge=0.0,
        le=1.0,
        description=(
            "How often pictures of one person give bodies that differ as much as these do; below "
            "0.1 a warning names the fit that differs most."
        ),
    )
    warnings: tuple[FitWarning, ...]
