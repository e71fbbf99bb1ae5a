"""A fit as a caller sees it: where it stands, what it reports, where its results are."""

from datetime import datetime
from enum import StrEnum
from uuid import UUID

from pydantic import Field

from api_schemas.base import WireModel
from api_schemas.problems import Problem


class JobState(StrEnum):
    """Where a job stands; the last four are final."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELED = "canceled"
    TIMED_OUT = "timed_out"


class FitLinks(WireModel):
    """Paths of a fit's resources below this service's root; absent ones do not exist (yet)."""

    self: str
    events: str
    request: str = Field(description="What was asked for.")
    cancel: str | None = Field(default=None, description="While the fit has not ended.")
    result: str | None = Field(default=None, description="Once it has succeeded.")
    products: str | None = Field(
        default=None, description="Where more can be made of it; once it has succeeded."
    )
    files: dict[str, str] = Field(
        description="By name: the pictures and masks that were sent, and those of the result."
    )


class Fit(WireModel):
    """One accepted fit, and where it stands."""

    id: UUID
    state: JobState
    stage: str | None = Field(description="The stage last reported.")
    view: int | None = Field(
        description=(
            "Of several pictures, the one that is searched by itself, from 0 on; null while all "
            "are searched together, and before and after."
        )
    )
    progress: float = Field(ge=0.0, le=1.0, description="The share of the work that is done.")
    attempt: int = Field(ge=0, description="How many times the work was started.")
    cancel_requested: bool
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    expires_at: datetime | None = Field(
        description="When the fit is erased with all it holds; null until it has ended."
    )
    problem: Problem | None = Field(description="Why there is no result; null unless it failed.")
    label: str | None = Field(description="What the request called the person.")
    links: FitLinks


class FitPage(WireModel):
    """Fits, newest first; ``next`` is the path of the following page."""

    fits: tuple[Fit, ...]
    next: str | None


class EventKind(StrEnum):
    """The ``event`` field of the event stream."""

    STATE = "state"
    PROGRESS = "progress"
    END = "end"


class EventData(WireModel):
    """The ``data`` field of every event; ``energies`` are the fit's named terms at that moment."""

    state: JobState
    stage: str | None
    view: int | None = Field(
        default=None,
        description="Of several pictures, the one that is searched by itself, from 0 on.",
    )
    progress: float = Field(ge=0.0, le=1.0)
    energies: dict[str, float] = Field(default_factory=dict[str, float])
    at: datetime
