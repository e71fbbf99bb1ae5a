"""Is the process alive, can it do its work, and its figures for Prometheus.

The first two are answered by the event loop itself, which no other request can keep waiting.
"""

from typing import Final

from fastapi import APIRouter, Request, Response
from prometheus_client.exposition import CONTENT_TYPE_LATEST

from api_schemas.service import Live, Ready
from service.api.context import Context, Parts
from service.api.problems import documented
from service.api.readiness import not_ready

ROUTER: Final = APIRouter(tags=["health"])


@ROUTER.get("/healthz/live", response_model=Live, summary="The process answers")
async def get_liveness() -> Live:
    """Answer."""
    return Live()


@ROUTER.get(
    "/healthz/ready",
    response_model=Ready,
    summary="A fit can be accepted and finished",
    responses=documented("not-ready"),
)
async def get_readiness(request: Request) -> Ready:
    """Check that database and storage can be written and a worker is alive and able to work.

    Answered within two seconds: a database or a storage that says nothing for so long is not
    available. Probes that come at the same time share one check.

    A worker is able once it has started a process for jobs, and until it cannot start any more:
    seconds after its start, or minutes where it compiles its numerics first. 503 also while this
    process is being stopped.
    """
    parts: Parts = request.app.state.parts
    if parts.draining.is_set():
        raise not_ready(code="draining", detail="This process is being stopped.")
    return await parts.readiness.ready()


@ROUTER.get(
    "/metrics",
    summary="Figures for Prometheus",
    response_class=Response,
    responses={
        200: {
            "description": "Prometheus' text format.",
            "content": {"text/plain": {"schema": {"type": "string"}}},
        }
    }
    | documented("not-ready", "internal-error"),
)
def get_metrics(context: Context) -> Response:
    """Return queue, workers, endings, durations and requests; needs a key made for metrics."""
    return Response(context.metrics.exposition(), media_type=CONTENT_TYPE_LATEST)
