"""A fit as a caller sees it: where it stands, what it reports, and the notice of its end."""

import base64
import binascii
from datetime import datetime
from enum import StrEnum
from typing import Annotated, Final
from uuid import UUID

from pydantic import AfterValidator, Field

from api_schemas.base import WireModel, refusal
from api_schemas.problems import Problem


class JobState(StrEnum):
    """State of a job; the last four are final."""

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
    """The ``event`` field of the event stream.

    ``end``, the last event, repeats the ``state`` before it.
    """

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


SECRET_PREFIX: Final = "whsec_"
MIN_SECRET_BYTES: Final = 24
MAX_SECRET_BYTES: Final = 64


def secret_key(secret: str) -> bytes:
    """The key behind a secret as it is written.

    Raises
    ------
    PydanticCustomError
        If it is not ``whsec_`` and the base64 of 24 to 64 bytes.
    """
    try:
        if not secret.startswith(SECRET_PREFIX):
            raise binascii.Error
        key = base64.b64decode(secret.removeprefix(SECRET_PREFIX), validate=True)
    except binascii.Error:
        key = b""
    if not MIN_SECRET_BYTES <= len(key) <= MAX_SECRET_BYTES:
        raise refusal(
            code="unusable-secret",
            reason=f"A secret is '{SECRET_PREFIX}' and the base64 of {MIN_SECRET_BYTES} to "
            f"{MAX_SECRET_BYTES} random bytes.",
            remedy="Make one with: echo whsec_$(openssl rand -base64 32)",
        )
    return key


def _usable_secret(secret: str) -> str:
    secret_key(secret)
    return secret


WebhookSecret = Annotated[str, AfterValidator(_usable_secret)]


class WebhookTarget(WireModel):
    """Destination of the notice of the fit's end.

    The address must be public: private, loopback and link-local ones are refused, ports other than
    443 and 80 as well, and redirects are not followed. Without a ``secret`` the service's own signs
    the notice; where it has none, a secret is needed.
    """

    url: str = Field(
        max_length=2_000,
        pattern=r"^https?://[^\s/?#@\\]+(?:[/?][^\s#]*)?$",
        examples=["https://example.org/hooks/maquette"],
        json_schema_extra={"format": "uri"},
    )
    secret: WebhookSecret | None = Field(
        default=None,
        pattern=f"^{SECRET_PREFIX}(?:[A-Za-z0-9+/]{{4}}){{8,21}}(?:[A-Za-z0-9+/]{{4}}|"
        "[A-Za-z0-9+/]{3}=|[A-Za-z0-9+/]{2}==)?$",
        description=f"'{SECRET_PREFIX}' and the base64 of 24 to 64 bytes; never answered.",
        examples=["whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD"],
    )


class WebhookEventType(StrEnum):
    """Outcome of the fit."""

    SUCCEEDED = "fit.succeeded"
    FAILED = "fit.failed"
    CANCELED = "fit.canceled"
    TIMED_OUT = "fit.timed_out"


class WebhookEvent(WireModel):
    """The body of a notice.

    ``data`` is the fit as ``GET /v1/fits/{id}`` answers it after its end, which is at
    ``timestamp``. The body is the same at every attempt.
    """

    type: WebhookEventType
    timestamp: datetime
    data: Fit
