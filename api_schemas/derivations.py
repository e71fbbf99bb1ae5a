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
from api_schemas.webhooks import WebhookTarget

FULL_TURN: Final = 6.2832
"""Radians, rounded up."""


TEXTURE_SIZES: Final = (512, 1_024, 2_048)
"""Sides a texture may have, texels."""

LEAST_OWN_TEXTURE: Final = 64
"""Side of the smallest texture that may be sent; the largest is the last of those above."""


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
        default=0.0,
        ge=0.0,
        le=3_600.0,
        description="Where the stretch begins, of the file or of a walk without end.",
    )
    duration_s: float | None = Field(
        default=None,
        gt=0.0,
        le=3_600.0,
        description=(
            "How long the stretch is; null goes on to the file's end, or is three strides of the "
            "walk. An animation has 30 frames a second and 360 in all at most: what is longer is "
            "cut, with a warning."
        ),
    )


class TextureColours(StrEnum):
    """The picture as it is, with its light, or the albedo found in it, to be lit anew.

    ``own`` are those of a painted atlas that comes along as the form's part ``texture``; they are
    taken for albedo.
    """

    PICTURE = "picture"
    ALBEDO = "albedo"
    OWN = "own"


class TextureOptions(DerivationOptions):
    """The picture, or a texture of one's own, laid on the body; albedo needs a fit with shading."""

    kind: Literal["texture"]
    colours: TextureColours = TextureColours.PICTURE
    size: Annotated[
        WholeNumber,
        AfterValidator(_texture_size),
        WithJsonSchema({"type": "integer", "enum": list(TEXTURE_SIZES)}),
    ] = Field(
        default=1_024, description="Side of the texture, texels; one's own keeps the side it has."
    )


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
            "known measurements. What is made of several fits is erased with any of them, and "
            "expires with the first."
        ),
        json_schema_extra={"uniqueItems": True},
    )


def _kind(value: Any) -> str | None:
    # In brackets, by which field names of problems leave the alternative out.
    is_object = isinstance(value, dict)
    kind = cast("dict[str, Any]", value).get("kind") if is_object else getattr(value, "kind", None)
    return f"[{kind}]" if isinstance(kind, str) else None


_KINDS: Final = ", ".join(f"'{kind}'" for kind in DerivationKind)
BY_KIND: Final = Discriminator(
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


class DerivationRequest(RootModel[Annotated[AnyDerivationOptions, BY_KIND]]):
    """What to derive from a fit; ``kind`` says which fields there are."""

    model_config = ConfigDict(frozen=True, strict=True, hide_input_in_errors=True)


class DerivationLinks(WireModel):
    """Paths of a derivation's resources below this service's root; absent ones are not (yet)."""

    self: str
    fit: str = Field(description="The fit it is derived from.")
    events: str
    request: str = Field(description="What was asked for.")
    cancel: str | None = Field(default=None, description="While the job has not ended.")
    retry: str | None = Field(default=None, description="Once it has ended.")
    result: str | None = None
    artifacts: dict[str, str] = Field(default_factory=dict[str, str])


class Derivation(JobStanding):
    """One accepted derivation; it is erased with its fit, and expires when the fit does.

    A combined one goes with any of its fits.
    """

    kind: DerivationKind
    fit_id: UUID
    links: DerivationLinks


class DerivationPage(WireModel):
    """Derivations of a fit, newest first; ``next`` is the path of the following page."""

    derivations: tuple[Derivation, ...]
    next: str | None


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
