"""Observation: an id, a log line and figures of each request; and all figures for Prometheus.

Queue, workers and endings come from the database and cover all machines together: if several API
processes are scraped, take the maximum of these series, not their sum.
"""

import contextlib
import logging
import re
import time
import uuid
from collections.abc import Iterator
from typing import Final

from prometheus_client import CollectorRegistry, Counter, Histogram
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    Metric,
)
from prometheus_client.exposition import generate_latest
from prometheus_client.registry import Collector
from starlette.datastructures import MutableHeaders
from starlette.requests import ClientDisconnect, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api_schemas.jobs import JobState
from api_schemas.problems import problem
from service.api.limits import PROBES
from service.api.problems import problem_response
from service.jobs.engine import JobEngine
from service.jobs.records import TERMINAL, EngineUnavailableError
from service.jobs.rows import BOUNDS_S
from service.process.data_folder import Disk
from service.process.logs import fields, log_context

LOG: Final = logging.getLogger(__name__)

HEADER: Final = "x-request-id"
WELL_FORMED: Final = re.compile(r"[A-Za-z0-9._-]{1,64}")


AVAILABLE: Final = ("maquette_database_available", "Whether this process reaches the database.")
REQUEST_BOUNDS_S: Final = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 30.0, 60.0)


class ServiceMetrics:
    """The registry of one application."""

    def __init__(self, engine: JobEngine, disk: Disk) -> None:
        self._registry = CollectorRegistry()
        self._registry.register(_EngineCollector(engine))
        self._registry.register(_DiskCollector(disk))
        self._requests = Counter(
            "maquette_http_requests",
            "Answered requests.",
            ["method", "route", "status"],
            registry=self._registry,
        )
        self._seconds = Histogram(
            "maquette_http_request_seconds",
            "Time to the end of the answer; event streams last as long as their listeners.",
            ["method", "route"],
            buckets=REQUEST_BOUNDS_S,
            registry=self._registry,
        )

    def count(self, *, method: str, route: str, status: int, seconds: float) -> None:
        """Count an answered request; ``route`` is the template, never the path."""
        self._requests.labels(method, route, str(status)).inc()
        self._seconds.labels(method, route).observe(seconds)

    def exposition(self) -> bytes:
        """Return everything in Prometheus' text format."""
        return generate_latest(self._registry)


class _DiskCollector(Collector):
    def __init__(self, disk: Disk) -> None:
        self._disk = disk

    def collect(self) -> Iterator[Metric]:
        free = self._disk.free_bytes()
        if free is not None:
            yield _gauge("maquette_disk_free_bytes", "Room left beside the data folder.", free)


class _EngineCollector(Collector):
    def __init__(self, engine: JobEngine) -> None:
        self._engine = engine

    def describe(self) -> Iterator[Metric]:
        # The database is not queried when the collector is registered.
        return iter(())

    def collect(self) -> Iterator[Metric]:
        try:
            statistics, workers = self._engine.statistics(), self._engine.workers()
        except EngineUnavailableError:
            # What this process counts itself is told all the same.
            yield _gauge(*AVAILABLE, 0.0)
            return
        yield _gauge(*AVAILABLE, 1.0)
        yield _gauge("maquette_queue_jobs", "Jobs that wait.", statistics.queued)
        yield _gauge("maquette_running_jobs", "Jobs that run.", statistics.running)
        yield _gauge(
            "maquette_queue_oldest_seconds",
            "How long the oldest of the waiting jobs has waited.",
            statistics.oldest_queued_s,
        )
        yield _gauge(
            "maquette_workers",
            "Workers that are alive.",
            sum(each.alive is True for each in workers),
        )
        yield _gauge(
            "maquette_workers_able",
            "Workers that are alive and can start processes for jobs.",
            sum(each.is_ready for each in workers),
        )
        outcomes = CounterMetricFamily(
            "maquette_jobs_ended", "Jobs that ever ended, by state.", labels=["state"]
        )
        for state in sorted(TERMINAL):
            outcomes.add_metric([JobState(state).value], statistics.outcomes.get(state, 0))
        yield outcomes
        yield _gauge(
            "maquette_job_crashes",
            "How often processes of the jobs that are kept have died.",
            statistics.crashes,
        )
        durations = HistogramMetricFamily(
            "maquette_job_seconds",
            "How long jobs waited and ran.",
            labels=["phase"],
        )
        for histogram in statistics.durations:
            buckets: list[tuple[str, float]] = []
            below = 0
            for bound, jobs in histogram.counts:
                below += jobs
                buckets.append(("+Inf" if bound == BOUNDS_S[-1] else f"{bound:g}", float(below)))
            durations.add_metric([histogram.phase], buckets, histogram.seconds)
        yield durations


def _gauge(name: str, documentation: str, value: float) -> Metric:
    return GaugeMetricFamily(name, documentation, value=value)


class Observation:
    """ASGI middleware, our outermost: sees every response, and turns an exception into one."""

    def __init__(self, app: ASGIApp, *, metrics: ServiceMetrics) -> None:
        self._app = app
        self._metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, with its id."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        method = request.method
        given = request.headers.get(HEADER, "")
        request_id = given if WELL_FORMED.fullmatch(given) else uuid.uuid4().hex
        request.state.request_id = request_id
        with log_context(request=request_id):
            started = time.monotonic()
            status = await self._answer(request, request_id, receive, send)
            seconds = time.monotonic() - started
            route = _route(scope)
            self._metrics.count(method=method, route=route, status=status, seconds=seconds)
            LOG.log(
                logging.DEBUG if request.url.path.startswith(PROBES) else logging.INFO,
                "%s %s",
                method,
                route,
                extra=fields(
                    status=status,
                    seconds=f"{seconds:.3f}",
                    **({"job": job} if (job := scope.get("path_params", {}).get("fit_id")) else {}),
                    **({"tenant": tenant} if (tenant := scope["state"].get("tenant")) else {}),
                ),
            )

    async def _answer(self, request: Request, request_id: str, receive: Receive, send: Send) -> int:
        # What the logs of proxies show for a client that hung up before there was an answer.
        status = 499

        async def identified(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                MutableHeaders(scope=message)[HEADER] = request_id
            await send(message)

        try:
            await self._app(request.scope, receive, identified)
        except ClientDisconnect:
            # The client hung up before its request was complete: there is nobody to answer.
            pass
        except Exception:
            LOG.exception("%s %s failed.", request.method, _route(request.scope))
            if status != 499:
                raise
            reason = problem(
                "internal-error",
                detail="An unexpected fault; it has been logged.",
                remedy="Try again later.",
            )
            await problem_response(request, reason)(request.scope, receive, identified)
        return status


def _route(scope: Scope) -> str:
    """The template of the path that answered: of limited number, and free of ids."""
    return getattr(scope.get("route"), "path", "other")


class _AnsweredError(Exception):
    """Ends an answer whose body nobody reads."""


class HeadAsGet:
    """ASGI middleware: HEAD is answered as GET is, without the body (RFC 9110 9.3.2)."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on; a stream ends with its headers."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return

        async def without_body(message: Message) -> None:
            if message["type"] != "http.response.body":
                await send(message)
                return
            await send({"type": "http.response.body", "body": b""})
            if message.get("more_body", False):
                raise _AnsweredError

        scope["method"] = "GET"
        with contextlib.suppress(_AnsweredError):
            await self._app(scope, receive, without_body)
