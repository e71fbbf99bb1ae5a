"""The result of a fit: ``result.json``."""

from pydantic import Field

from api_schemas.base import WireModel
from api_schemas.picture import Light
from fitter.vocabulary.choices import (
    Cues,
    Gender,
    OptimizerKind,
    ViewKind,
)
from fitter.vocabulary.outcomes import (
    FocalLengthSource,
    LimbFacing,
    Outcome,
    StanceKind,
    Verdict,
    WornRegion,
)
from fitter.vocabulary.remarks import Remark

Vector = tuple[float, float, float]


class CameraResult(WireModel):
    """A pinhole camera on a picture of ``width`` x ``height`` continuous pixels."""

    focal_length_px: float
    centre_x: float
    centre_y: float
    width: int
    height: int


class TiltResult(WireModel):
    """Tilt of the camera against gravity, inferred from how the person stands.

    In the camera frame (x right, y down, z along the view) up is (-sin roll cos pitch, -cos roll
    cos pitch, sin pitch). ``stance`` is the most probable kind, ``stances`` the probability of
    each.
    """

    pitch_deg: float = Field(
        description="Positive where it looks up, negative where it looks down."
    )
    pitch_standard_error_deg: float
    roll_deg: float = Field(
        description="Positive where it is turned clockwise, seen from behind it."
    )
    roll_standard_error_deg: float
    stance: StanceKind
    stances: dict[StanceKind, float]


class BodyResult(WireModel):
    """Pose, position and shape of the body.

    ``pose`` are the turns of the parts relative to their parents: axis times angle, radians, body
    frame. ``translation_m`` is the pelvis joint in the camera frame (metres, x right, y down, z
    along the view); ``shape`` are coefficients in standard deviations, the first of them the
    height.
    """

    pose: dict[str, Vector]
    translation_m: Vector
    shape: tuple[float, ...]


class ReflectanceResult(WireModel):
    """The skin's reflectance in linear light; the per-vertex values are in ``body_posed.glb``."""

    ambient: float
    specular_exponent: float
    mean_albedo: float
    mean_specularity: float


class Measurement(WireModel):
    """One anthropometric measurement in its unit.

    ``standard_error`` is null where unknown, and zero where the request gave the value exactly.
    95 % of true values lie between ``low`` and ``high``.
    """

    name: str
    value: float
    unit: str
    standard_error: float | None
    low: float | None
    high: float | None
    given: bool = Field(description="Whether the request gave it.")
    definition: str
    source: str


class Stage(WireModel):
    """The person at the end of a stage of the fit: energies, and measurements by their names."""

    name: str
    energies: dict[str, float]
    measurements: dict[str, float]


class ResultFile(WireModel):
    """A file of the result."""

    name: str
    media_type: str
    size: int
    sha256: str


class ViewResult(WireModel):
    """The person in one of the pictures, with the shape that all have in common.

    ``camera`` belongs to the working picture the fit was made on, ``image_camera`` to the upright
    original. ``light`` and ``reflectance`` are null for SE, which does not estimate them. The files
    of the picture have names that begin with its place, ``views/0/overlay.png``.
    """

    view: ViewKind | None = Field(
        description="From where the request said that the picture shows the person."
    )
    outcome: Outcome
    verdict: Verdict
    camera: CameraResult
    image_camera: CameraResult
    focal_length_source: FocalLengthSource
    body: BodyResult
    light: Light | None
    reflectance: ReflectanceResult | None
    silhouette_overlap: float = Field(description="Intersection over union of body and silhouette.")
    tilt: TiltResult | None = Field(description="Null where the person says nothing of it.")
    limb_facing: tuple[LimbFacing, ...]
    findings: tuple[Remark, ...] = Field(
        description=(
            "As of `POST /v1/points`; what `blocks` withholds the measurements, what `harms` "
            "widens those that it harms. Of a fit alone: `contradicted`, no person was measured; "
            "`covered`, something is before or beside the person."
        )
    )
    clothing: tuple[WornRegion, ...] = Field(
        description="Empty where it was said that all clothes are `tight`."
    )
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]


class FitResult(WireModel):
    """``result.json``: one body, and how it stands in each of the pictures.

    ``assumptions`` and ``warnings`` are of the person and of the fit as a whole; those of a picture
    are with it in ``views``.
    """

    gender: Gender
    height_m: float
    cues: Cues
    optimizer: OptimizerKind
    energies: dict[str, float]
    evaluations: int
    measurements: tuple[Measurement, ...] = Field(
        description=(
            "Empty, as in the stages, where the verdict is `implausible` or `no_person` and the "
            "request did not `force` them; without those that a warning, `measurements-withheld`, "
            "names in `where`: their ranges would be wider than those of all people as tall."
        )
    )
    shape: tuple[float, ...]
    verdict: Verdict = Field(description="The worst of the pictures'.")
    outcome_explanation: str = Field(description="Of the picture whose verdict is the worst.")
    agreement: float | None = Field(
        ge=0.0,
        le=1.0,
        description=(
            "How often pictures of one person, each by itself, give bodies that differ as much as "
            "these do; below 0.1 a warning names the view that differs most. Null of one picture."
        ),
    )
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]
    differences: tuple[str, ...] = Field(description="From the paper, of a fit by its method.")
    stages: tuple[Stage, ...]
    stage_seconds: dict[str, float]
    files: tuple[ResultFile, ...]
    views: tuple[ViewResult, ...]
