"""Through which lens a picture was taken, in requests."""

from typing import Self

from pydantic import Field, model_validator

from api_schemas.base import WireModel, refusal


class Lens(WireModel):
    """At most one focal length; without one the picture's EXIF data are asked."""

    focal_length_px: float | None = Field(
        default=None, gt=0.0, le=1_000_000.0, description="Focal length in pixels of the picture."
    )
    focal_length_35mm: float | None = Field(
        default=None, ge=5.0, le=5_000.0, description="Focal length in 35 mm equivalent."
    )

    @model_validator(mode="after")
    def _one_focal_length(self) -> Self:
        if self.focal_length_px is not None and self.focal_length_35mm is not None:
            raise refusal(
                code="two-focal-lengths",
                reason="Both focal_length_px and focal_length_35mm are given.",
                field="focal_length_35mm",
                remedy="Send one of the two.",
            )
        return self
