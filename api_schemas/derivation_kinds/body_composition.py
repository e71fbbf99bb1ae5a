"""Body-fat share: what is asked for, and what comes of it."""

from typing import Literal

from pydantic import Field

from api_schemas.base import WireModel
from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles


class BodyCompositionOptions(DerivationOptions):
    """The share of fat by published regressions on girths, each with its own error.

    It is the estimate of a formula, not a finding, and no replacement for a physician's.
    """

    kind: Literal["body_composition"]
    age_years: float | None = Field(
        default=None,
        ge=0.0,
        le=120.0,
        description="Without it the person is taken for an adult of working age.",
    )


class BodyFatEstimate(WireModel):
    """What one regression says; nothing but why, where the person is not of its population.

    The squares of ``regression_error`` and ``measurement_error`` sum to that of ``standard_error``:
    what the regression errs by with people who were measured by hand, and what the errors of the
    measurements here, all together, make of it.
    """

    name: str = Field(description="Stable.", examples=["us_navy", "cun_bae"])
    source: str
    population: str = Field(description="Of whom it was learned.")
    differences: str = Field(description="What is measured otherwise here.")
    percent: float | None = Field(description="Fat in percent of the weight.")
    standard_error: float | None
    regression_error: float
    measurement_error: float | None
    low: float | None = Field(description="Of the 95 % interval.")
    high: float | None
    inputs: tuple[str, ...] = Field(description="The measurements it is made of.")
    withheld: tuple[str, ...] = Field(description="Why it says nothing; empty where it does.")


class BodyCompositionResult(DerivedFiles):
    """The estimates, and ``body_composition.csv``, the same as a table."""

    kind: Literal["body_composition"] = "body_composition"
    age_years: float | None
    bmi: float = Field(description="Body mass index, kg per square metre.")
    bmi_standard_error: float
    estimates: tuple[BodyFatEstimate, ...]
