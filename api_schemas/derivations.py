"""What is derived from a finished fit: a job of its own, by its kind."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated, Any, Final, Literal, cast
from uuid import UUID

from pydantic import (
    AfterValidator,
    ConfigDict,
    Discriminator,
    Field,
    RootModel,
    Tag,
    WithJsonSchema,
)

from api_schemas.base import WholeNumber, WireModel, refusal
from api_schemas.jobs import JobStanding
from api_schemas.results import Artifact, FitWarning, Measurement, PartRotation
from api_schemas.webhooks import WebhookTarget

FULL_TURN: Final = 6.2832
"""Radians, rounded up."""


TEXTURE_SIZES: Final = (512, 1_024, 2_048)
"""Sides a texture may have, texels."""


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


def _texture_size(size: int) -> int:
    if size in TEXTURE_SIZES:
        return size
    raise refusal(
        code="unknown-value",
        reason=f"A texture of {size} texels cannot be made.",
        remedy=f"Use {', '.join(map(str, TEXTURE_SIZES[:-1]))} or {TEXTURE_SIZES[-1]}.",
    )


class DerivationKind(StrEnum):
    """What can be made of a fit."""

    REPORT = "report"
    CARICATURE = "caricature"
    POSE = "pose"
    ANIMATION = "animation"
    TEXTURE = "texture"
    FIGURE = "figure"
    COMBINED = "combined"


class NamedPose(StrEnum):
    """Poses by name; ``rest`` is the body model's own, with half-raised arms."""

    REST = "rest"
    STANDING = "standing"
    A_POSE = "a_pose"
    T_POSE = "t_pose"
    RELAXED = "relaxed"
    WALKING = "walking"
    SITTING = "sitting"
    ARMS_RAISED = "arms_raised"


class DerivationOptions(WireModel):
    """What all requests for a derivation have in common."""

    webhook: WebhookTarget | None = None


class ReportOptions(DerivationOptions):
    """One page for people, as HTML and as PDF."""

    kind: Literal["report"]


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


Rotation = Annotated[
    tuple[Annotated[float, Field(ge=-FULL_TURN, le=FULL_TURN)], ...],
    Field(
        min_length=3,
        max_length=4,
        description=(
            "Three numbers are axis times angle in radians, four a unit quaternion x, y, z, w."
        ),
    ),
]


class PoseOptions(DerivationOptions):
    """The body in another pose: a named one, or one spelled out part by part."""

    kind: Literal["pose"]
    pose: NamedPose = NamedPose.REST
    rotations: dict[str, Rotation] = Field(
        default_factory=dict[str, Rotation],
        max_length=64,
        description=(
            "Parts that are held otherwise than in `pose`, by the names of `/v1/body-models`: "
            "their turn relative to the parent part, from the rest pose, in the body frame (x to "
            "the person's left, y up, z forward). Joints turn only as far as people's do."
        ),
        examples=[{"left_forearm": [0.0, 1.2, 0.0]}],
    )


class AnimationOptions(DerivationOptions):
    """The body in motion: by a BVH file that comes along, or walking."""

    kind: Literal["animation"]
    start_s: float = Field(
        default=0.0, ge=0.0, le=3_600.0, description="Where the stretch of the file begins."
    )
    duration_s: float | None = Field(
        default=None,
        gt=0.0,
        le=3_600.0,
        description=(
            "How long the stretch is; null goes on to the file's end. An animation has 30 frames a "
            "second and 360 in all at most: what is longer is cut, with a warning."
        ),
    )


class TextureColours(StrEnum):
    """The picture as it is, with its light, or the albedo found in it, to be lit anew."""

    PICTURE = "picture"
    ALBEDO = "albedo"


class TextureOptions(DerivationOptions):
    """The picture laid on the body; the albedo needs a fit with shading."""

    kind: Literal["texture"]
    colours: TextureColours = TextureColours.PICTURE
    size: Annotated[
        WholeNumber,
        AfterValidator(_texture_size),
        WithJsonSchema({"type": "integer", "enum": list(TEXTURE_SIZES)}),
    ] = Field(default=1_024, description="Side of the texture, texels.")


class FigureOptions(DerivationOptions):
    """Picture, overlay, recovered body and a new pose side by side, as in the paper's Fig. 10."""

    kind: Literal["figure"]
    pose: NamedPose = NamedPose.STANDING
    degrees: float = Field(
        default=0.0,
        ge=-360.0,
        le=360.0,
        description="How far the onlooker of the two bodies has walked to the right round them.",
    )


class CombinedOptions(DerivationOptions):
    """One person from several of their pictures: this fit and others of the same person."""

    kind: Literal["combined"]
    fits: Annotated[tuple[UUID, ...], AfterValidator(_each_once)] = Field(
        min_length=1,
        max_length=MOST_OTHER_FITS,
        description=(
            "Other fits that have succeeded, of the same person, with the same gender, height and "
            "known measurements."
        ),
        json_schema_extra={"uniqueItems": True},
    )


def _kind(value: Any) -> str | None:
    # In brackets, by which field names of problems leave the alternative out.
    is_object = isinstance(value, dict)
    kind = cast("dict[str, Any]", value).get("kind") if is_object else getattr(value, "kind", None)
    return f"[{kind}]" if isinstance(kind, str) else None


_KINDS: Final = ", ".join(f"'{kind}'" for kind in DerivationKind)
_BY_KIND: Final = Discriminator(
    _kind,
    custom_error_type="unknown-value",
    custom_error_message="{reason}",
    custom_error_context={
        "field": "kind",
        "reason": "The request does not say what is to be derived.",
        "remedy": f"Send as kind one of {_KINDS}.",
    },
)


AnyDerivationOptions = (
    Annotated[ReportOptions, Tag("[report]")]
    | Annotated[CaricatureOptions, Tag("[caricature]")]
    | Annotated[PoseOptions, Tag("[pose]")]
    | Annotated[AnimationOptions, Tag("[animation]")]
    | Annotated[TextureOptions, Tag("[texture]")]
    | Annotated[FigureOptions, Tag("[figure]")]
    | Annotated[CombinedOptions, Tag("[combined]")]
)


class DerivationRequest(RootModel[Annotated[AnyDerivationOptions, _BY_KIND]]):
    """What to derive from a fit; ``kind`` says which fields there are."""

    model_config = ConfigDict(frozen=True, strict=True, hide_input_in_errors=True)


class DerivationLinks(WireModel):
    """Paths of a derivation's resources below this service's root; absent ones are not (yet)."""

    self: str
    fit: str = Field(description="The fit it is derived from.")
    events: str
    request: str = Field(description="What was asked for.")
    cancel: str | None = Field(default=None, description="While the job has not ended.")
    result: str | None = None
    artifacts: dict[str, str] = Field(default_factory=dict[str, str])


class Derivation(JobStanding):
    """One accepted derivation; it is erased with its fit, and expires when the fit does."""

    kind: DerivationKind
    fit_id: UUID
    links: DerivationLinks


class DerivationPage(WireModel):
    """Derivations of a fit, newest first; ``next`` is the path of the following page."""

    derivations: tuple[Derivation, ...]
    next: str | None


class DerivedFiles(WireModel):
    """What all results of derivations have in common."""

    artifacts: tuple[Artifact, ...]


class ReportResult(DerivedFiles):
    """``report.html`` and ``report.pdf``, the same page; both stand alone."""

    kind: Literal["report"] = "report"


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


class PoseResult(DerivedFiles):
    """``body_reposed.glb``, standing on the ground and facing +z, and ``pose.png``."""

    kind: Literal["pose"] = "pose"
    pose: tuple[PartRotation, ...]


class AnimationResult(DerivedFiles):
    """``body_animated.glb``, ``body_skinned.glb``, ``animation.png`` and ``animation.webp``.

    The first holds the bodies of SCAPE as morph targets, the second bones and a skin that follows
    them linearly, which is only near to SCAPE; errors are distances of vertices from SCAPE's.
    """

    kind: Literal["animation"] = "animation"
    source: str = Field(description="Where the motion comes from.")
    frames: int
    frame_time_s: float
    morph_targets: int
    morph_mean_error_mm: float
    morph_largest_error_mm: float
    skin_mean_error_mm: float
    skin_largest_error_mm: float
    sliding_mm: float = Field(
        description="How far soles on the ground slide from frame to frame, on average."
    )
    travelled_m: float = Field(description="From the first place to the last, along the ground.")
    warnings: tuple[FitWarning, ...]


class TextureResult(DerivedFiles):
    """``body_textured.glb``, in the fitted pose, ``texture.png`` and ``coverage.png``.

    White texels of the last were seen in the picture, grey ones are taken from the other side of
    the body, black ones continued from their surroundings: these two kinds are invented. An albedo
    may exceed 1: it is the texture's linear value times ``scale``.
    """

    kind: Literal["texture"] = "texture"
    colours: TextureColours
    size: int
    seen_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    mirrored_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    scale: float


class FigureResult(DerivedFiles):
    """``figure.png``."""

    kind: Literal["figure"] = "figure"
    pose: NamedPose


class CombinedResult(DerivedFiles):
    """``body_combined.glb``, in the canonical pose, and ``combined.png``, beside this fit alone."""

    kind: Literal["combined"] = "combined"
    pictures: int
    shape: tuple[float, ...]
    measurements: tuple[Measurement, ...]
    agreement: float = Field(
        ge=0.0,
        le=1.0,
        description=(
            "How often pictures of one person give bodies that differ as much as these do; below "
            "0.01 a warning names the fit that differs most."
        ),
    )
    warnings: tuple[FitWarning, ...]


AnyDerivationResult = (
    Annotated[ReportResult, Tag("[report]")]
    | Annotated[CaricatureResult, Tag("[caricature]")]
    | Annotated[PoseResult, Tag("[pose]")]
    | Annotated[AnimationResult, Tag("[animation]")]
    | Annotated[TextureResult, Tag("[texture]")]
    | Annotated[FigureResult, Tag("[figure]")]
    | Annotated[CombinedResult, Tag("[combined]")]
)


class DerivationResult(RootModel[Annotated[AnyDerivationResult, _BY_KIND]]):
    """``result.json`` of a derivation; ``kind`` says which fields there are."""

    model_config = ConfigDict(frozen=True, strict=True)


class DerivationEventType(StrEnum):
    """How the job ended."""

    SUCCEEDED = "derivation.succeeded"
    FAILED = "derivation.failed"
    CANCELED = "derivation.canceled"
    TIMED_OUT = "derivation.timed_out"


class DerivationEvent(WireModel):
    """The body of a notice.

    ``data`` is the derivation as its own path answers it, but for ``webhook``, which is null.
    ``timestamp`` is when the job ended.
    """

    type: DerivationEventType
    timestamp: datetime
    data: Derivation
