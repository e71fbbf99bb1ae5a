"""Is the process there, and can it do its work."""

import shutil
from typing import Final

from fastapi import APIRouter

from api_schemas.health import Live, Ready
from api_schemas.problems import problem
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, documented

ROUTER: Final = APIRouter(prefix="/healthz", tags=["health"])


@ROUTER.get("/live", response_model=Live, summary="The process answers")
def live() -> Live:
    """Answer."""
    return Live()


@ROUTER.get(
    "/ready",
    response_model=Ready,
    summary="A fit can be accepted and finished",
    responses=documented("not-ready"),
)
def ready(context: Context) -> Ready:
    """Check that the database can be written, the disk has room and a worker is alive."""
    context.engine.check_writable()
    workers = context.engine.live_workers()
    if _free_disk_mb(context) < context.settings.min_free_disk_mb:
        raise _not_ready(code="disk-full", detail="The disk of the data folder is nearly full.")
    if workers == 0:
        raise _not_ready(code="no-worker", detail="No worker is alive.")
    return Ready(workers=workers, queued=context.engine.queued())


def _free_disk_mb(context: ApiContext) -> float:
    return shutil.disk_usage(context.settings.data_dir).free / 1e6


def _not_ready(*, code: str, detail: str) -> ProblemError:
    return ProblemError(
        problem("not-ready", code=code, detail=detail, remedy="Try again in a moment.")
    )
