"""Is the process alive, and can it do its work."""

from typing import Final

from fastapi import APIRouter

from api_schemas.health import Live, Ready
from api_schemas.problems import problem
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, documented
from service.blobs import BlobsUnavailableError, StorageFullError

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
    """Check that database and storage can be written and a worker was seen to be alive.

    A fit may still wait some seconds for a worker that has just started, or minutes where that
    compiles its numerics first. 503 also while the process is being stopped.
    """
    if context.draining.is_set():
        raise _not_ready(code="draining", detail="This process is being stopped.")
    _check_disk(context)
    context.engine.check_writable()
    _check_storage(context)
    workers = sum(worker.alive is True for worker in context.engine.workers())
    if workers == 0:
        raise _not_ready(code="no-worker", detail="No worker is alive.")
    return Ready(workers=workers, queued=context.engine.queued())


def _check_disk(context: ApiContext) -> None:
    # First: a database on a full disk cannot be written, and would be reported as unavailable.
    if not context.disk.has_room_for():
        raise _not_ready(code="disk-full", detail="The disk of the data folder is nearly full.")


def _check_storage(context: ApiContext) -> None:
    try:
        context.blobs.check_writable()
    except StorageFullError as error:
        raise _not_ready(code="disk-full", detail="The storage is full.") from error
    except BlobsUnavailableError as error:
        raise _not_ready(
            code="storage-unavailable", detail="The storage cannot be written."
        ) from error


def _not_ready(*, code: str, detail: str) -> ProblemError:
    return ProblemError(
        problem("not-ready", code=code, detail=detail, remedy="Try again in a moment.")
    )
