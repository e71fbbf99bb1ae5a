"""Is the process alive, and can it do its work.

Both are answered by the event loop itself, which no other request can keep waiting.
"""

from typing import Final

from fastapi import APIRouter, Request

from api_schemas.health import Live, Ready
from service.api.context import Parts
from service.api.problems import documented
from service.api.readiness import not_ready

ROUTER: Final = APIRouter(prefix="/healthz", tags=["health"])


@ROUTER.get("/live", response_model=Live, summary="The process answers")
async def get_liveness() -> Live:
    """Answer."""
    return Live()


@ROUTER.get(
    "/ready",
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
