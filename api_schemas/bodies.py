"""Bodies without a picture: gender and known measurements in, the most probable body out."""

from typing import Annotated, Final

from pydantic import Field, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.requests import Gender, HeightM

STATURE: Final = "stature"
MAX_NAME_LENGTH: Final = 64

MeasurementName = Annotated[
    str, Field(min_length=1, max_length=MAX_NAME_LENGTH, examples=["waist_girth_navel"])
]
MeasuredValue = Annotated[float, Field(gt=0.0, le=10_000.0, examples=[84.0])]


class UncertainMeasurement(WireModel):
    """A measurement with the standard error it was taken with, both in its unit."""

    value: MeasuredValue
    standard_error: float = Field(ge=0.0, le=1_000.0, examples=[1.5])


class BodyRequest(WireModel):
    """Of whom what is known.

    ``measurements`` are by the names, and in the units, of a result's measurements
    (`GET /v1/body-models` lists them). A number is held exactly; with a standard error the body
    is drawn toward it as far as it is certain.
    """

    gender: Gender
    height_m: HeightM | None = None
    measurements: dict[MeasurementName, MeasuredValue | UncertainMeasurement] = Field(
        default_factory=dict[str, float | UncertainMeasurement],
        examples=[{"weight": 64.5, "waist_girth_navel": {"value": 78, "standard_error": 1.5}}],
    )
    include_glb: bool = Field(
        default=False,
        description=(
            "Put the body's GLB file into the JSON answer. `Accept: model/gltf-binary` answers "
            "with the file itself instead."
        ),
    )

    @model_validator(mode="after")
    def _one_height(self) -> "BodyRequest":
        if self.height_m is not None and STATURE in self.measurements:
            raise refusal(
                code="two-heights",
                reason="Both height_m and measurements.stature are given.",
                field="height_m",
                remedy="Send one of the two.",
            )
        return self


class EstimatedMeasurement(WireModel):
    """A measurement of the most probable body.

    Of people of whom the same is known ``standard_error`` is the standard deviation, and 95 % lie
    between ``low`` and ``high``; what the body model itself gets wrong is not in them.
    """

    name: str
    value: float
    unit: str
    standard_error: float
    low: float
    high: float
    given: bool = Field(description="Whether the request named it.")
    definition: str
    source: str


class BodyEstimate(WireModel):
    """The most probable body of whoever has the known measurements.

    ``shape`` are coefficients in standard deviations, the first of them the height.
    ``plausibility`` is the share of the population whose measurements of the given names are
    together at least as unusual.
    """

    gender: Gender
    height_m: float
    shape: tuple[float, ...]
    measurements: tuple[EstimatedMeasurement, ...]
    plausibility: float = Field(ge=0.0, le=1.0)
    body_model: str = Field(description="Checksum of the body model.")
    glb: str | None = Field(
        default=None,
        description="The body as a glTF 2.0 binary file, canonical pose, base64; if asked for.",
        json_schema_extra={"contentEncoding": "base64", "contentMediaType": "model/gltf-binary"},
    )
