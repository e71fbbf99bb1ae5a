"""Jobs in plain types, as the API and the worker see them, and the states they may be in."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final

from api_schemas.jobs import EventData, EventKind, JobState
from api_schemas.problems import Problem
from api_schemas.results import ResultFile

FIT: Final = "fit"
"""The kind of jobs that are no products."""


ACTIVE: Final = frozenset({JobState.QUEUED, JobState.RUNNING})
TERMINAL: Final = frozenset(JobState) - ACTIVE

TRANSITIONS: Final[Mapping[JobState, frozenset[JobState]]] = {
    JobState.QUEUED: frozenset({JobState.RUNNING, JobState.FAILED, JobState.CANCELED}),
    JobState.RUNNING: ACTIVE | TERMINAL,
} | {state: frozenset[JobState]() for state in TERMINAL}
"""Legal changes of a job's state::

    queued <─> running ──> succeeded | failed | canceled | timed_out
       └─────────────────> failed | canceled

A running job goes back to the queue when its worker is stopped. When the worker dies instead, the
job is run again with the next attempt: running ──> running.
"""


def may_become(state: JobState) -> frozenset[JobState]:
    """The states from which a job may enter ``state``."""
    return frozenset(source for source, targets in TRANSITIONS.items() if state in targets)


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredBlob:
    """A blob in the job's scope."""

    digest: str
    media_type: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Idempotency:
    """A caller's key, hashed, and a fingerprint of the request it came with."""

    key: str
    fingerprint: str


@dataclass(frozen=True, slots=True, kw_only=True)
class NewJob:
    """A fit or a product to accept; its blobs are stored, ``options`` being the request as JSON.

    ``inputs`` is what else it needs, by name, ``pictures`` of them pictures of a person that came
    with the request: so many jobs it counts for while it waits. ``request_id`` identifies the HTTP
    request in logs; ``webhook`` is a blob too, a :class:`api_schemas.jobs.WebhookTarget` as
    JSON: whom to notify of the job's end. ``label`` is what the caller calls the person.
    """

    id: str
    kind: str
    options: StoredBlob
    inputs: Mapping[str, StoredBlob]
    pictures: int = 1
    label: str | None = None
    idempotency: Idempotency | None = None
    request_id: str | None = None
    webhook: StoredBlob | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class JobRecord:
    """A stored job; times are seconds since the epoch.

    ``parent`` is the fit that a product is made of, None for a fit, and ``product`` says which of
    that fit's products it is. ``view`` is the picture that its stage
    is about, where there are several. ``result_files`` are those of its result.
    """

    id: str
    tenant: str
    kind: str
    parent: str | None
    product: str | None
    state: JobState
    stage: str | None
    view: int | None
    progress: float
    attempt: int
    cancel_requested: bool
    created_at: float
    started_at: float | None
    finished_at: float | None
    expires_at: float | None
    problem: Problem | None
    options: StoredBlob
    inputs: Mapping[str, StoredBlob]
    pictures: int
    label: str | None
    result_files: tuple[ResultFile, ...]
    fingerprint: str | None
    last_event: int
    request_id: str | None
    webhook: StoredBlob | None

    @property
    def scope(self) -> str:
        """Scope of its blobs: a product's lie beside its fit's."""
        return self.parent or self.id

    @property
    def made(self) -> Mapping[str, StoredBlob]:
        """All that came of it, by name."""
        return {
            each.name: StoredBlob(digest=each.sha256, media_type=each.media_type)
            for each in self.result_files
        }

    @property
    def files(self) -> Mapping[str, StoredBlob]:
        """All that was sent, and all that came of it, by name."""
        return {**self.inputs, **self.made}


@dataclass(frozen=True, slots=True, kw_only=True)
class JobEvent:
    """One entry of a job's event stream; ``number`` counts from 1 without gaps."""

    number: int
    kind: EventKind
    data: EventData


class EngineUnavailableError(Exception):
    """The engine's database is unavailable or full; nothing was changed."""


class EngineFullError(EngineUnavailableError):
    """The disk of the engine's database is full; nothing was changed."""


class EngineDamagedError(EngineUnavailableError):
    """The file of the engine's database is damaged, and is used no more."""


class DatabaseUnusableError(Exception):
    """The database cannot be used as it is; the message, one line, says what to do."""


class JobExpiredError(Exception):
    """The job has been erased, or is about to be, because it has expired."""

    def __init__(self, expired_at: float) -> None:
        super().__init__(expired_at)
        self.expired_at = expired_at


class SubmitOutcome(StrEnum):
    """Outcome of a submission.

    ``TENANT_FULL``: too many jobs of this tenant are waiting. ``LOST``: the blobs of the job were
    considered abandoned and erased before it was submitted. ``FIT_GONE``: the fit of a product was
    erased meanwhile.
    """

    ACCEPTED = "accepted"
    REPEATED = "repeated"
    KEY_REUSED = "key_reused"
    QUEUE_FULL = "queue_full"
    TENANT_FULL = "tenant_full"
    LOST = "lost"
    FIT_GONE = "fit_gone"


@dataclass(frozen=True, slots=True, kw_only=True)
class Submission:
    """The outcome, and the job: the new one, or the earlier one with the same idempotency key."""

    outcome: SubmitOutcome
    job: JobRecord | None


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerStatus:
    """A worker as seen from here.

    ``alive`` is None as long as the worker has been seen only once and nothing can be said.
    ``able`` is what it says of itself with its heartbeat: that it can start processes for jobs.
    """

    executor_id: str
    alive: bool | None
    able: bool

    @property
    def is_ready(self) -> bool:
        """Whether the worker is known to be alive, and able to work."""
        return self.alive is True and self.able


@dataclass(frozen=True, slots=True, kw_only=True)
class DurationHistogram:
    """Durations of a phase of jobs, seconds: numbers of jobs by upper bound, and the sum."""

    phase: str
    counts: tuple[tuple[float, int], ...]
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class EngineStatistics:
    """The current queue, all that ever ended, and crashes of the jobs that are kept."""

    queued: int
    running: int
    oldest_queued_s: float
    outcomes: Mapping[JobState, int]
    durations: tuple[DurationHistogram, ...]
    crashes: int


class Directive(StrEnum):
    """Instruction to a running attempt."""

    CONTINUE = "continue"
    CANCELED = "canceled"
    SUPERSEDED = "superseded"


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """Progress to store."""

    stage: str
    progress: float
    energies: dict[str, float] = field(default_factory=dict[str, float])
    view: int | None = None


class Ending(StrEnum):
    """Outcome of an attempt: one of a job's, or one of the last two.

    ``CRASHED`` attempts are repeated up to a limit.
    """

    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELED = "canceled"
    TIMED_OUT = "timed_out"
    CRASHED = "crashed"
    SUPERSEDED = "superseded"


@dataclass(frozen=True, slots=True, kw_only=True)
class AttemptResult:
    """The result of an attempt: references to blobs, never the blobs themselves."""

    ending: Ending
    files: tuple[ResultFile, ...] = ()
    problem: Problem | None = None
