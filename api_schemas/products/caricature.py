"""A caricature: what is asked for, and what comes of it."""

from enum import StrEnum
from typing import Literal

from pydantic import Field

from api_schemas.products.base import ProductOptions, ProductResult


class Exaggerated(StrEnum):
    """What a caricature multiplies."""

    COEFFICIENT = "coefficient"
    LOOKS = "looks"


class CaricatureOptions(ProductOptions):
    """The body with what is unusual of it exaggerated, as tall as it is."""

    kind: Literal["caricature"]
    factor: float = Field(
        default=2.0,
        ge=0.0,
        le=100.0,
        description=(
            "By which it is multiplied; 1 is the body as it was fitted. Where the surface would "
            "turn inside out or run through itself, the job fails and names the largest factor "
            "that can be used."
        ),
    )
    exaggerated: Exaggerated = Field(
        default=Exaggerated.COEFFICIENT,
        description=(
            "`coefficient`: the shape coefficient that deviates most from the mean, as in the "
            "paper; often little is seen of it. `looks`: all coefficients but the height's, so "
            "how the body differs from the average one of its height."
        ),
    )


class CaricatureResult(ProductResult):
    """``body_caricature.glb``, in the fitted pose, and ``caricature.png``, beside the fitted body.

    ``coefficient`` is the index, in ``shape`` of the fit's result, of what deviates most; with
    ``looks`` the others are multiplied by the same factor.
    """

    kind: Literal["caricature"] = "caricature"
    factor: float
    coefficient: int = Field(ge=1)
    before: float = Field(description="Of the fitted body, in standard deviations.")
    after: float = Field(description="Of the caricature.")
    height_m: float = Field(description="Of both.")
    shape: tuple[float, ...] = Field(description="All of the caricature's coefficients.")
