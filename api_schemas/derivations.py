"""What is derived from a finished fit: a job of its own, by its kind."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated, Any, Final, Literal, cast
from uuid import UUID

from pydantic import ConfigDict, Discriminator, Field, RootModel, Tag

from api_schemas.base import WireModel
from api_schemas.jobs import JobStanding
from api_schemas.results import Artifact, PartRotation
from api_schemas.webhooks import WebhookTarget

FULL_TURN: Final = 6.2832
"""Radians, rounded up."""


class DerivationKind(StrEnum):
    """What can be made of a fit."""

    REPORT = "report"
    CARICATURE = "caricature"
    POSE = "pose"


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


AnyDerivationResult = (
    Annotated[ReportResult, Tag("[report]")]
    | Annotated[CaricatureResult, Tag("[caricature]")]
    | Annotated[PoseResult, Tag("[pose]")]
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
