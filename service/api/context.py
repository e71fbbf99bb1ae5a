"""What the resources share, built once in :func:`service.api.app.create_app`, and for whom."""

import threading
from dataclasses import dataclass
from typing import Annotated, Final

from anyio import CapacityLimiter
from fastapi import Depends, Request

from service.api.estimates import Estimates
from service.api.event_feed import EventFeed
from service.api.service_metrics import ServiceMetrics
from service.blobs import BlobStore
from service.engine.image_port import TenantImages
from service.engine.port import FIT, SCAN, JobEngine, TenantJobs
from service.process.disk import Disk
from service.settings import Settings

SOLE_TENANT: Final = "default"
"""The tenant of all jobs if no keys are required."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Parts:
    """Settings, engine, blobs, disk, estimates, events, metrics; ``draining`` once told to stop.

    ``copying`` lets few requests at once copy what other jobs were made of.
    """

    settings: Settings
    engine: JobEngine
    blobs: BlobStore
    disk: Disk
    estimates: Estimates
    feed: EventFeed
    metrics: ServiceMetrics
    draining: threading.Event
    copying: CapacityLimiter


@dataclass(frozen=True, slots=True, kw_only=True)
class ApiContext:
    """The parts for one request: ``jobs``, its tenant's fits, ``scans`` and ``images``."""

    settings: Settings
    engine: JobEngine
    blobs: BlobStore
    disk: Disk
    estimates: Estimates
    feed: EventFeed
    metrics: ServiceMetrics
    draining: threading.Event
    copying: CapacityLimiter
    tenant: str
    jobs: TenantJobs
    scans: TenantJobs
    images: TenantImages
    request_id: str | None


def _context(request: Request) -> ApiContext:
    parts: Parts = request.app.state.parts
    tenant: str = request.state.tenant
    return ApiContext(
        settings=parts.settings,
        engine=parts.engine,
        blobs=parts.blobs,
        disk=parts.disk,
        estimates=parts.estimates,
        feed=parts.feed,
        metrics=parts.metrics,
        draining=parts.draining,
        copying=parts.copying,
        tenant=tenant,
        jobs=parts.engine.of(tenant, FIT),
        scans=parts.engine.of(tenant, SCAN),
        images=parts.engine.images_of(tenant),
        request_id=getattr(request.state, "request_id", None),
    )


Context = Annotated[ApiContext, Depends(_context)]
