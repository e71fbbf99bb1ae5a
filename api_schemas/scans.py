"""Scans: one person measured from several pictures taken for it, as one job."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from enum import StrEnum
from typing import Annotated, Any, Final
from uuid import UUID

from pydantic import AfterValidator, Field

from api_schemas.base import WireModel, refusal
from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivations import DerivationEventType
from api_schemas.images import ImageId
from api_schemas.jobs import JobStanding, ResourceLinks
from api_schemas.labels import LABEL_OF_JOB, Label
from api_schemas.points import AUTO, Point, Points
from api_schemas.requests import (
    AskedPicture,
    AskedPoints,
    PersonChoices,
    PictureChoices,
    PictureFacts,
)
from api_schemas.results import (
    STAGES,
    Assumption,
    FitWarning,
    LimbFacing,
    PersonResult,
    StageBody,
    StageResult,
    ViewResult,
)
from api_schemas.webhooks import WebhookTarget
from fitter.vocabulary.choices import OptimizerKind, ViewKind
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.points import PointName

LEAST_VIEWS: Final = 2
MOST_VIEWS: Final = 6


SEEN_ONCE: Final = (ViewKind.FRONT, ViewKind.BACK)
"""Views of which a scan has one at most: people have two sides, but one front."""


class View(WireModel):
    """A picture's view of the person."""

    view: ViewKind


class ScanViewOptions(PictureChoices, PictureFacts, View):
    """One picture, as it was understood: points are named, and none where all are proposed."""

    points: Points


class ScanViewRequest(AskedPicture, View):
    """One of the pictures: from where it shows the person, its points, its lens."""

    points: AskedPoints = AUTO

    def options(self, points: Mapping[PointName, Point]) -> ScanViewOptions:
        """The view, of these named points."""
        values = {name: getattr(self, name) for name in ScanViewOptions.model_fields}
        return ScanViewOptions.model_construct(**values | self.named(points))


class ScanViewOfImage(ScanViewRequest):
    """One of the pictures, uploaded before."""

    image_id: ImageId
    mask_id: ImageId | None = Field(
        default=None,
        description="A grey picture of the same size; the person is brighter than half.",
    )


class ScanOptions(PersonChoices):
    """One scan, as it was understood."""

    # What is stored for a worker of an earlier version says nothing that it does not know.
    optimizer: OptimizerKind = Field(
        default=OptimizerKind.GAUSS_NEWTON,
        exclude_if=lambda optimizer: optimizer is OptimizerKind.GAUSS_NEWTON,
    )
    views: tuple[ScanViewOptions, ...]

    @property
    def pictures(self) -> tuple[ScanViewOptions, ...]:
        """What is asked of each of its pictures."""
        return self.views


def _usable_together(views: tuple[ScanViewRequest, ...]) -> tuple[ScanViewRequest, ...]:
    if not LEAST_VIEWS <= len(views) <= MOST_VIEWS:
        raise refusal(
            code="views-count",
            field="views",
            reason=f"A scan has {LEAST_VIEWS} to {MOST_VIEWS} pictures, not {len(views)}.",
            remedy="Send the person from the front and from the side, and more if there are.",
        )
    for number, each in enumerate(views):
        if each.view in SEEN_ONCE and any(each.view is other.view for other in views[:number]):
            raise refusal(
                code="repeated-view",
                field=f"views.{number}.view",
                reason=f"Two pictures are said to show the {each.view}.",
                remedy="Send one of them, or say what the other shows: "
                f"{', '.join(kind for kind in ViewKind if kind is not each.view)}.",
            )
    return views


_VIEWS: Final[dict[str, Any]] = {
    "description": (
        f"{LEAST_VIEWS} to {MOST_VIEWS} pictures of the person, `front` and `side` to begin with. "
        "At most one each is `front` or `back`; sizes, lenses and orientations may differ. Faults "
        "of a view have fields that begin with its place, `views.1.points`."
    ),
    "json_schema_extra": {"minItems": LEAST_VIEWS, "maxItems": MOST_VIEWS},
}


class ScanRequest(PersonChoices):
    """The JSON part ``request`` of a submission; `image_0` is the picture of its first view."""

    views: Annotated[tuple[ScanViewRequest, ...], AfterValidator(_usable_together), Field(**_VIEWS)]
    label: Label | None = Field(default=None, description=LABEL_OF_JOB, examples=["customer-4711"])
    webhook: WebhookTarget | None = Field(
        default=None, description="Where to tell of the job's end."
    )

    @property
    def pictures(self) -> tuple[ScanViewRequest, ...]:
        """What is asked of each of its pictures."""
        return self.views

    def understood(self, points: Sequence[Mapping[PointName, Point]]) -> ScanOptions:
        """The scan alone, without what concerns only the submission.

        Parameters
        ----------
        points
            Those of every picture, by their names.
        """
        values = {name: getattr(self, name) for name in PersonChoices.model_fields}
        views = tuple(view.options(each) for view, each in zip(self.views, points, strict=True))
        return ScanOptions.model_construct(**values, views=views)


class ScanOfImages(ScanRequest):
    """A submission whose pictures were uploaded before."""

    views: Annotated[  # pyright: ignore[reportIncompatibleVariableOverride]
        tuple[ScanViewOfImage, ...], AfterValidator(_usable_together), Field(**_VIEWS)
    ]

    @property
    def pictures(self) -> tuple[ScanViewOfImage, ...]:
        """What is asked of each of its pictures."""
        return self.views


class ScanViewLinks(WireModel):
    """Paths of what was sent for one view."""

    image: str = Field(description="The picture.")
    mask: str | None = Field(default=None, description="The mask, if one was sent.")


class ScanLinks(ResourceLinks):
    """Paths of a scan's resources below this service's root; absent ones do not exist (yet)."""

    views: tuple[ScanViewLinks, ...]
    derivations: str | None = Field(
        default=None, description="What was derived from the scan; once it has succeeded."
    )


class Scan(JobStanding):
    """One accepted scan."""

    view: int | None = Field(
        description=(
            "The picture that is searched by itself, from 0 on; null while all are searched "
            "together, and before and after."
        )
    )
    label: str | None = Field(default=None, description="What the request called the person.")
    links: ScanLinks


class ScanPage(WireModel):
    """Scans, newest first; ``next`` is the path of the following page."""

    scans: tuple[Scan, ...]
    next: str | None


class ScannedView(ViewResult):
    """The person in one of the pictures.

    ``camera`` belongs to the working picture, ``image_camera`` to the upright original. The
    picture's files have ``number`` in their names, ``body_posed_N.glb``, ``overlay_N.png`` and so
    on, with ``number`` for N.
    """

    number: int = Field(ge=0, description="Its place in the request, from 0 on.")
    view: ViewKind
    limb_facing: tuple[LimbFacing, ...] = Field(
        default=(), description="Empty in results of earlier versions."
    )
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]


class ScanStage(StageResult):
    """One person at the end of a stage of a scan, and how they then stand in each picture."""

    views: tuple[StageBody, ...]


class ScanResult(PersonResult):
    """``result.json`` of a scan: one body, and how it stands in each picture.

    ``assumptions`` and ``warnings`` are of the person and of the scan as a whole; those of a
    picture are with it in ``views``. Earlier versions wrote neither ``optimizer`` nor ``energies``,
    ``evaluations``, ``stages`` and ``stage_seconds``.
    """

    optimizer: OptimizerKind = OptimizerKind.GAUSS_NEWTON
    energies: dict[str, float] = Field(default_factory=dict[str, float])
    evaluations: int = Field(
        default=0, description="Of each picture by itself and of all together; 0 is not known."
    )
    stages: tuple[ScanStage, ...] = Field(default=(), description=STAGES)
    stage_seconds: dict[str, float] = Field(default_factory=dict[str, float])
    verdict: Verdict = Field(description="The worst of the views'.")
    outcome_explanation: str = Field(description="Of the view whose verdict is the worst.")
    shape: tuple[float, ...]
    views: tuple[ScannedView, ...]
    agreement: float = Field(
        ge=0.0,
        le=1.0,
        description=(
            "How often pictures of one person, each by itself, give bodies that differ as much as "
            "these do; below 0.1 a warning names the view that differs most."
        ),
    )


class ScanEventType(StrEnum):
    """How the job ended."""

    SUCCEEDED = "scan.succeeded"
    FAILED = "scan.failed"
    CANCELED = "scan.canceled"
    TIMED_OUT = "scan.timed_out"


class ScanEvent(WireModel):
    """The body of a notice.

    ``data`` is the scan as its own path answers it, but for ``webhook``, which is null.
    ``timestamp`` is when the job ended.
    """

    type: ScanEventType
    timestamp: datetime
    data: Scan


class ScanDerivationLinks(ResourceLinks):
    """Paths of a derivation's resources below this service's root; absent ones are not (yet)."""

    scan: str = Field(description="The scan it is derived from.")


class ScanDerivation(JobStanding):
    """One accepted derivation of a scan; it is erased with its scan, and expires when it does."""

    kind: DerivationKind
    scan_id: UUID
    links: ScanDerivationLinks


class ScanDerivationPage(WireModel):
    """Derivations of a scan, newest first; ``next`` is the path of the following page."""

    derivations: tuple[ScanDerivation, ...]
    next: str | None


class ScanDerivationEvent(WireModel):
    """The body of a notice of the end of a derivation of a scan."""

    type: DerivationEventType
    timestamp: datetime
    data: ScanDerivation
