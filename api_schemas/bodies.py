"""Bodies without a picture: gender and known measurements in, the most probable body out."""

from pydantic import Field

from api_schemas.base import WireModel
from api_schemas.person import Person
from api_schemas.results import FitWarning
from fitter.vocabulary.choices import Gender


class BodyRequest(Person):
    """Of whom what is known."""

    include_glb: bool = Field(
        default=False,
        description=(
            "Put the body's GLB file into the JSON answer. `Accept: model/gltf-binary` answers "
            "with the file itself instead."
        ),
    )


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
    """The most probable body of a person with the known measurements.

    ``shape`` are coefficients in standard deviations, the first of them the height.
    ``plausibility`` is the share of the population whose measurements of the given names are
    together at least as unusual. Warnings: ``unusual-height`` where bodies of the height are
    extrapolated, with wider errors.
    """

    gender: Gender
    height_m: float
    shape: tuple[float, ...]
    measurements: tuple[EstimatedMeasurement, ...]
    plausibility: float = Field(ge=0.0, le=1.0)
    body_model: str = Field(description="Checksum of the body model.")
    warnings: tuple[FitWarning, ...] = ()
    glb: str | None = Field(
        default=None,
        description="The body as a glTF 2.0 binary file, canonical pose, base64; if asked for.",
        json_schema_extra={"contentEncoding": "base64", "contentMediaType": "model/gltf-binary"},
    )
