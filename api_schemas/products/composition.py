"""Body-fat share: what is asked for, and what comes of it."""

from typing import Literal

from pydantic import Field

from api_schemas.base import WireModel
from api_schemas.products.base import ProductOptions, ProductResult


class CompositionOptions(ProductOptions):
    """The share of fat by published regressions on girths, each with its own error.

    It is the estimate of a formula, not a finding, and no replacement for a physician's.
    """

    kind: Literal["composition"]
    age_years: float | None = Field(
        default=None,
        ge=0.0,
        le=120.0,
        description="Without it the person is taken for an adult of working age.",
    )


class BodyFatEstimate(WireModel):
    """What one regression says; nothing but why, where the person is not of its population."""

    name: str = Field(description="Stable.", examples=["us_navy", "cun_bae"])
    source: str
    population: str = Field(description="Of whom it was learned.")
    percent: float | None = Field(description="Fat in percent of the weight.")
    standard_error: float | None = Field(
        description="Of the regression and of the measurements it is made of, together."
    )
    withheld: tuple[str, ...] = Field(description="Why it says nothing; empty where it does.")


class CompositionResult(ProductResult):
    """The estimates, and ``composition.csv``, the same as a table."""

    kind: Literal["composition"] = "composition"
    bmi: float = Field(description="Body mass index, kg per square metre.")
    estimates: tuple[BodyFatEstimate, ...]
