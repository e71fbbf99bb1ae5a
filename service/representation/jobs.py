"""Job records as callers see them."""

from datetime import UTC, datetime
from typing import Any, Final
from uuid import UUID

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivations import Derivation, DerivationLinks
from api_schemas.jobs import Job, JobLinks, JobState, WebhookDelivery
from api_schemas.scans import (
    Scan,
    ScanDerivation,
    ScanDerivationLinks,
    ScanLinks,
    ScanViewLinks,
)
from service.engine.port import FIT, SCAN, JobRecord, WebhookRecord
from service.jobs.inputs import MASK, pictures_of
from service.jobs.states import ACTIVE

POLL_AFTER_S: Final = 1
"""What Retry-After says for a job that has not ended."""


def collection_path(root: str) -> str:
    """Path of the fits, or of the scans, below the service's root."""
    return f"/v1/{root}s"


def derivations_path(root: str, parent_id: str) -> str:
    """Path of what is derived from a fit or a scan, below the service's root."""
    return f"{collection_path(root)}/{parent_id}/derivations"


def job_path(record: JobRecord) -> str:
    """Path of a job below the service's root."""
    if record.parent is None:
        return f"{collection_path(record.root)}/{record.id}"
    return f"{derivations_path(record.root, record.parent)}/{record.id}"


def list_path(record: JobRecord) -> str:
    """Path of the list that a job is in."""
    return job_path(record).rpartition("/")[0]


def represent(record: JobRecord) -> Job | Scan | Derivation | ScanDerivation:
    """Translate a record."""
    is_of_fits = record.root == FIT
    if record.parent is None:
        return _fit(record) if is_of_fits else _scan(record)
    of_root = _derivation if is_of_fits else _scan_derivation
    return of_root(record, record.parent)


def _fit(record: JobRecord) -> Job:
    path = job_path(record)
    succeeded = record.state is JobState.SUCCEEDED
    return Job(
        **_standing(record),
        label=record.label,
        links=JobLinks(
            **_links(record),
            image=f"{path}/image",
            mask=f"{path}/mask" if MASK in record.inputs else None,
            derivations=derivations_path(FIT, record.id) if succeeded else None,
        ),
    )


def _scan(record: JobRecord) -> Scan:
    path = job_path(record)
    succeeded = record.state is JobState.SUCCEEDED
    return Scan(
        **_standing(record),
        view=record.view,
        label=record.label,
        links=ScanLinks(
            **_links(record),
            views=tuple(
                ScanViewLinks(
                    image=f"{path}/views/{number}/image",
                    mask=None if picture.mask is None else f"{path}/views/{number}/mask",
                )
                for number, picture in enumerate(pictures_of(record.inputs))
            ),
            derivations=derivations_path(SCAN, record.id) if succeeded else None,
        ),
    )


def _derivation(record: JobRecord, fit: str) -> Derivation:
    return Derivation(
        **_standing(record),
        kind=DerivationKind(record.kind),
        fit_id=UUID(fit),
        links=DerivationLinks(**_links(record), fit=f"{collection_path(FIT)}/{fit}"),
    )


def _scan_derivation(record: JobRecord, scan: str) -> ScanDerivation:
    return ScanDerivation(
        **_standing(record),
        kind=DerivationKind(record.kind),
        scan_id=UUID(scan),
        links=ScanDerivationLinks(**_links(record), scan=f"{collection_path(SCAN)}/{scan}"),
    )


def _standing(record: JobRecord) -> dict[str, Any]:
    return {
        "id": UUID(record.id),
        "state": record.state,
        "stage": record.stage,
        "progress": record.progress,
        "attempt": record.attempt,
        "cancel_requested": record.cancel_requested,
        "created_at": _moment(record.created_at),
        "started_at": None if record.started_at is None else _moment(record.started_at),
        "finished_at": None if record.finished_at is None else _moment(record.finished_at),
        "expires_at": None if record.expires_at is None else _moment(record.expires_at),
        "problem": record.problem,
        "webhook": None if record.webhook is None else _delivery(record.webhook),
    }


def _links(record: JobRecord) -> dict[str, Any]:
    path = job_path(record)
    active = record.state in ACTIVE
    return {
        "self": path,
        "events": f"{path}/events",
        "request": f"{path}/request",
        "cancel": f"{path}/cancel" if active else None,
        "retry": None if active else f"{path}/retry",
        "result": f"{path}/result" if record.state is JobState.SUCCEEDED else None,
        "artifacts": {
            artifact.name: f"{path}/artifacts/{artifact.name}" for artifact in record.artifacts
        },
    }


def _delivery(webhook: WebhookRecord) -> WebhookDelivery:
    return WebhookDelivery(
        state=webhook.state,
        attempts=webhook.attempts,
        last_status=webhook.last_status,
        last_error=webhook.last_error,
        next_attempt_at=None
        if webhook.next_attempt_at is None
        else _moment(webhook.next_attempt_at),
    )


def _moment(seconds: float) -> datetime:
    return datetime.fromtimestamp(seconds, UTC)
