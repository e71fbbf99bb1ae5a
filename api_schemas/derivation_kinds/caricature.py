"""A caricature: what is asked for, and what comes of it."""

from typing import Literal

from pydantic import Field

from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles


class CaricatureOptions(DerivationOptions):
    """The body with what is most unusual of it exaggerated, as tall as it is."""

    kind: Literal["caricature"]
    factor: float = Field(
        default=2.0,
        ge=0.0,
        le=100.0,
        description=(
            "By which the shape coefficient that deviates most from the mean is multiplied; 1 is "
            "the body as it was fitted. Where the surface would turn inside out or run through "
            "itself, the job fails and names the largest factor that can be used."
        ),
    )


class CaricatureResult(DerivedFiles):
    """``body_caricature.glb``, in the fitted pose, and ``caricature.png``, beside the fitted body.

    ``coefficient`` is the index, in ``shape`` of the fit's result, of what was multiplied.
    """

    kind: Literal["caricature"] = "caricature"
    factor: float
    coefficient: int = Field(ge=1)
    before: float = Field(description="Of the fitted body, in standard deviations.")
    after: float = Field(description="Of the caricature.")
    height_m: float = Field(description="Of both.")
    shape: tuple[float, ...] = Field(description="All of the caricature's coefficients.")
