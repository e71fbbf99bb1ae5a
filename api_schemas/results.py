"""What a fit gives back: ``result.json``."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Any, Final

from pydantic import ConfigDict, Field

from api_schemas.base import WireModel
from fitter.vocabulary.choices import (
    BodyRegion,
    Covering,
    Cues,
    Facing,
    Gender,
    LightKind,
    OptimizerKind,
    ViewKind,
)
from fitter.vocabulary.outcomes import (
    FacingSource,
    FocalLengthSource,
    Outcome,
    Severity,
    StanceKind,
    Verdict,
)
from fitter.vocabulary.points import PointName

Vector = tuple[float, float, float]
Box = tuple[float, float, float, float]
"""Left, top, right and bottom, pixels of the picture as a browser shows it."""


class CameraResult(WireModel):
    """A pinhole camera on a picture of ``width`` x ``height`` continuous pixels."""

    focal_length_px: float
    centre_x: float
    centre_y: float
    width: int
    height: int


class FittedCameraResult(CameraResult):
    """The camera of a picture, with how it was held against gravity.

    That is told by how the person stands: in the camera frame (x right, y down, z along the view)
    up is (-sin roll cos pitch, -cos roll cos pitch, sin pitch). Null in results that were made
    before it was estimated.
    """

    pitch_deg: float | None = Field(
        default=None, description="Positive where it looks up, negative where it looks down."
    )
    pitch_standard_error_deg: float | None = None
    roll_deg: float | None = Field(
        default=None, description="Positive where it is turned clockwise, seen from behind it."
    )
    roll_standard_error_deg: float | None = None


class StanceResult(WireModel):
    """How the person stands: the most probable kind, and the probability of each."""

    kind: StanceKind
    probabilities: dict[StanceKind, float]


class PartRotation(WireModel):
    """The turn of one body part relative to its parent: axis times angle, radians, body frame."""

    part: str
    rotation: Vector


class BodyResult(WireModel):
    """Pose, position and shape of the body.

    ``translation_m`` is the pelvis joint in the camera frame (metres, x right, y down, z along the
    view); ``shape`` are coefficients in standard deviations, the first of them the height.
    """

    pose: tuple[PartRotation, ...]
    translation_m: Vector
    shape: tuple[float, ...]


class LightResult(WireModel):
    """The light found; angles as in the request, distance from the body's centre."""

    kind: LightKind
    azimuth_deg: float
    elevation_deg: float
    distance_m: float | None = Field(description="Null for a directional light.")


class ReflectanceResult(WireModel):
    """The skin's reflectance in linear light; the per-vertex values are in ``body_posed.glb``."""

    ambient: float
    specular_exponent: float
    mean_albedo: float
    mean_specularity: float


WITHIN_95: Final = 1.96
"""So many standard errors to either side hold 95 % of true values."""


def _bound(errors: float) -> Any:
    """What follows from value and error, which alone earlier versions have stored."""

    def said(measured: Mapping[str, Any]) -> float | None:
        error = measured["standard_error"]
        return None if error is None else round(measured["value"] + errors * error, 2)

    return Field(default_factory=said)


class Measurement(WireModel):
    """One anthropometric measurement in its unit.

    ``standard_error`` is null where unknown, and zero where the request gave the value exactly.
    95 % of true values lie between ``low`` and ``high``.
    """

    model_config = ConfigDict(json_schema_serialization_defaults_required=True)

    name: str
    value: float
    unit: str
    standard_error: float | None
    low: float | None = _bound(-WITHIN_95)
    high: float | None = _bound(WITHIN_95)
    given: bool = Field(description="Whether the request gave it.")
    definition: str
    source: str


class StageMeasurement(WireModel):
    """A measurement of a stage's body; the result's measurements say how each is taken."""

    name: str
    value: float
    unit: str
    standard_error: float | None
    given: bool = Field(description="Whether the request gave it.")
    # The next version leaves these two out: they stand in the result's own measurements.
    definition: str = Field(json_schema_extra={"deprecated": True})
    source: str = Field(json_schema_extra={"deprecated": True})


class StageResult(WireModel):
    """What is the same in all pictures at the end of a stage."""

    name: str
    energies: dict[str, float]
    measurements: tuple[StageMeasurement, ...]


class StageBody(WireModel):
    """The body in a picture at the end of a stage."""

    silhouette_overlap: float
    body: BodyResult


class Stage(StageBody, StageResult):
    """The body at the end of a stage of the fit."""


class ResultPart(StrEnum):
    """A part of a result that is left out unless it is asked for."""

    STAGES = "stages"


STAGES: Final = "Empty unless asked for with `include=stages`."


class LimbFacing(WireModel):
    """How a limb's depth ambiguity was resolved; ``ambiguous`` says the other way fits as well."""

    limb: str
    facing: Facing
    source: FacingSource
    ambiguous: bool
    alternative_energy: float | None


class Assumption(WireModel):
    """A physical quantity the caller did not give."""

    quantity: str
    value: float | str
    reason: str


class FitWarning(WireModel):
    """Something to look at."""

    code: str
    message: str


class Artifact(WireModel):
    """A file of the result."""

    name: str
    media_type: str
    size: int
    sha256: str


class PictureResult(WireModel):
    """The person in one of several pictures, with the shape that all have in common.

    Its fields are as in the result of a fit.
    """

    outcome: Outcome
    image_camera: FittedCameraResult
    body: BodyResult
    light: LightResult | None
    reflectance: ReflectanceResult | None
    silhouette_overlap: float = Field(description="Intersection over union of body and silhouette.")


class Finding(WireModel):
    """Something that is wrong with the picture.

    ``reason`` has the figure that was measured, ``remedy`` says what to do; ``points`` and ``box``
    (left, top, right, bottom) say where it is, if at one place.
    """

    code: str
    severity: Severity
    reason: str
    remedy: str
    points: tuple[PointName, ...]
    box: Box | None


class WornRegion(WireModel):
    """How a region of the person is most probably covered.

    ``bare`` is covered by underwear at most, a head that shows mostly skin; hair and hats are
    ``loose``. ``ease_cm`` is how far loose clothes stand off the
    trunk, or off seat and legs, where the outline shows them; null elsewhere.
    """

    region: BodyRegion
    kind: Covering
    probability: float
    ease_cm: float | None
    ease_standard_error_cm: float | None


class ViewResult(PictureResult):
    """What a fit finds in one picture."""

    outcome_explanation: str
    verdict: Verdict
    camera: FittedCameraResult
    focal_length_source: FocalLengthSource
    stance: StanceResult | None
    limb_facing: tuple[LimbFacing, ...]
    findings: tuple[Finding, ...] = Field(
        description="As of `POST /v1/checks`; what `blocks` withholds the measurements."
    )
    clothing: tuple[WornRegion, ...] = Field(
        default=(),
        exclude_if=lambda worn: not worn,
        description="Left out where it was said that all clothes are `tight`.",
    )


class PersonResult(WireModel):
    """What a fit finds out about the person in its pictures."""

    gender: Gender
    height_m: float
    cues: Cues
    optimizer: OptimizerKind
    energies: dict[str, float]
    evaluations: int
    measurements: tuple[Measurement, ...] = Field(
        description=(
            "Empty, as in the stages, where the verdict is `implausible` or `no_person` and the "
            "request did not `force` them."
        )
    )
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
    stage_seconds: dict[str, float]
    artifacts: tuple[Artifact, ...]


class FitResult(ViewResult, PersonResult):
    """The whole result of a fit.

    ``camera`` belongs to the working picture the fit was made on, ``image_camera`` to the upright
    original. ``light`` and ``reflectance`` are null for SE, which does not estimate them.
    """

    # What has a default was not written by some earlier version; and of the last two an earlier
    # version's worker, which refuses what it does not know, is told only what is there to tell.
    verdict: Verdict = Verdict.PLAUSIBLE
    stance: StanceResult | None = Field(
        default=None, description="Null in results that were made before it was estimated."
    )
    view: ViewKind | None = Field(
        default=None,
        exclude_if=lambda view: view is None,
        description="From where the request said that the picture shows the person.",
    )
    findings: tuple[Finding, ...] = Field(
        default=(),
        exclude_if=lambda findings: not findings,
        description="As of `POST /v1/checks`; what `blocks` withholds the measurements, what "
        "`harms` widens those that it harms. Not of checks: `contradicted`, no person was "
        "measured; `covered`, something is before or beside the person.",
    )
    stages: tuple[Stage, ...] = Field(description=STAGES)
    differences: tuple[str, ...] = Field(
        default=(),
        exclude_if=lambda differences: not differences,
        description="From the paper, of a fit by its method.",
    )
