"""Records of fits as callers see them."""

from datetime import UTC, datetime
from typing import Final
from uuid import UUID

from api_schemas.jobs import Fit, FitLinks, JobState
from service.jobs.records import ACTIVE, JobRecord

FITS: Final = "/v1/fits"
"""Path of the fits below the service's root."""

POLL_AFTER_S: Final = 1
"""What Retry-After says for a fit that has not ended."""


def fit_path(fit_id: str) -> str:
    """Path of a fit below the service's root."""
    return f"{FITS}/{fit_id}"


def represent(record: JobRecord) -> Fit:
    """Translate a record."""
    return Fit(
        id=UUID(record.id),
        state=record.state,
        stage=record.stage,
        view=record.view,
        progress=record.progress,
        attempt=record.attempt,
        cancel_requested=record.cancel_requested,
        created_at=_moment(record.created_at),
        started_at=None if record.started_at is None else _moment(record.started_at),
        finished_at=None if record.finished_at is None else _moment(record.finished_at),
        expires_at=None if record.expires_at is None else _moment(record.expires_at),
        problem=record.problem,
        label=record.label,
        links=_links(record),
    )


def _links(record: JobRecord) -> FitLinks:
    path = fit_path(record.id)
    succeeded = record.state is JobState.SUCCEEDED
    return FitLinks(
        self=path,
        events=f"{path}/events",
        request=f"{path}/request",
        cancel=f"{path}/cancel" if record.state in ACTIVE else None,
        result=f"{path}/result" if succeeded else None,
        products=f"{path}/products" if succeeded else None,
        files={name: f"{path}/files/{name}" for name in record.files},
    )


def _moment(seconds: float) -> datetime:
    return datetime.fromtimestamp(seconds, UTC)
