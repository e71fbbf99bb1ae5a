"""Job records as callers see them."""

from datetime import UTC, datetime
from typing import Any, Final
from uuid import UUID

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivations import Derivation, DerivationLinks
from api_schemas.jobs import Job, JobLinks, JobState, WebhookDelivery
from service.engine.port import JobRecord, WebhookRecord
from service.jobs.inputs import MASK
from service.jobs.states import ACTIVE

POLL_AFTER_S: Final = 1
"""What Retry-After says for a job that has not ended."""


def derivations_path(fit_id: str) -> str:
    """Path of what is derived from a fit, below the service's root."""
    return f"/v1/fits/{fit_id}/derivations"


def job_path(record: JobRecord) -> str:
    """Path of a job below the service's root."""
    if record.parent is None:
        return f"/v1/fits/{record.id}"
    return f"{derivations_path(record.parent)}/{record.id}"


def represent(record: JobRecord) -> Job:
    """Translate the record of a fit."""
    path = job_path(record)
    succeeded = record.state is JobState.SUCCEEDED
    return Job(
        **_standing(record),
        links=JobLinks(
            **_links(record),
            image=f"{path}/image",
            mask=f"{path}/mask" if MASK in record.inputs else None,
            derivations=derivations_path(record.id) if succeeded else None,
        ),
    )


def represent_derivation(record: JobRecord) -> Derivation:
    """Translate the record of a derivation.

    Raises
    ------
    ValueError
        If it is the record of a fit.
    """
    if record.parent is None:
        message = f"job {record.id} is derived from nothing"
        raise ValueError(message)
    return Derivation(
        **_standing(record),
        kind=DerivationKind(record.kind),
        fit_id=UUID(record.parent),
        links=DerivationLinks(**_links(record), fit=f"/v1/fits/{record.parent}"),
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
