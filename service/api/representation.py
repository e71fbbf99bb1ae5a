"""Job records as callers see them."""

from datetime import UTC, datetime
from typing import Final
from uuid import UUID

from api_schemas.jobs import Job, JobLinks, JobState, WebhookDelivery
from service.engine.port import JobRecord, WebhookRecord
from service.jobs import ACTIVE

POLL_AFTER_S: Final = 1
"""What Retry-After says of a job that has not ended."""


def job_path(job_id: str) -> str:
    """Path of a job below the service's root."""
    return f"/v1/fits/{job_id}"


def represent(record: JobRecord) -> Job:
    """Translate a record."""
    path = job_path(record.id)
    active = record.state in ACTIVE
    return Job(
        id=UUID(record.id),
        state=record.state,
        stage=record.stage,
        progress=record.progress,
        attempt=record.attempt,
        cancel_requested=record.cancel_requested,
        created_at=_moment(record.created_at),
        started_at=None if record.started_at is None else _moment(record.started_at),
        finished_at=None if record.finished_at is None else _moment(record.finished_at),
        expires_at=None if record.expires_at is None else _moment(record.expires_at),
        problem=record.problem,
        webhook=None if record.webhook is None else _delivery(record.webhook),
        links=JobLinks(
            self=path,
            events=f"{path}/events",
            image=f"{path}/image",
            request=f"{path}/request",
            cancel=f"{path}/cancel" if active else None,
            retry=None if active else f"{path}/retry",
            result=f"{path}/result" if record.state is JobState.SUCCEEDED else None,
            artifacts={
                artifact.name: f"{path}/artifacts/{artifact.name}" for artifact in record.artifacts
            },
        ),
    )


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
