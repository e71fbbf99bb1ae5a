"""The parts that all resources share, and the tenant of one request."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Annotated, Any

from fastapi import Depends, Request

from service.api.estimators import Estimators
from service.api.events import EventFeed
from service.api.observation import ServiceMetrics
from service.jobs.blobs import WatchedBlobs
from service.jobs.engine import JobEngine, TenantJobs
from service.jobs.images import TenantImages
from service.process.data_folder import Disk
from service.settings import Settings
from service.submissions.image_header import ReadHeader


@dataclass(frozen=True, slots=True, kw_only=True)
class Parts:
    """Settings, engine, blobs, disk, estimators and so on; ``draining`` once told to stop."""

    settings: Settings
    engine: JobEngine
    blobs: WatchedBlobs
    disk: Disk
    estimators: Estimators
    feed: EventFeed
    metrics: ServiceMetrics
    draining: threading.Event
    read_header_for: Callable[[str], ReadHeader]


@dataclass(frozen=True, slots=True, kw_only=True)
class ApiContext(Parts):
    """The parts, and for one request those of its tenant."""

    tenant: str
    jobs: TenantJobs
    images: TenantImages
    read_header: ReadHeader
    request_id: str | None


def _context(request: Request) -> ApiContext:
    parts: Parts = request.app.state.parts
    tenant: str = request.state.tenant
    engine = parts.engine
    shared: dict[str, Any] = {each.name: getattr(parts, each.name) for each in fields(Parts)}
    shared["estimators"] = parts.estimators.of(tenant)
    return ApiContext(
        **shared,
        tenant=tenant,
        jobs=engine.of(tenant),
        images=engine.images_of(tenant),
        read_header=parts.read_header_for(tenant),
        request_id=getattr(request.state, "request_id", None),
    )


Context = Annotated[ApiContext, Depends(_context)]
