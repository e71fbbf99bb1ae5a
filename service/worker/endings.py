"""Problems for attempts that their child did not end itself, as reported to callers."""

from api_schemas.problems import Problem, problem
from service.blobs import BlobsUnavailableError, StorageFullError
from service.engine.port import Ending


def ending_by(reason: Problem) -> Ending:
    """How an attempt ended whose process told of this problem."""
    is_late = reason.type == too_slow(0.0).type
    return Ending.TIMED_OUT if is_late else Ending.FAILED


def input_gone() -> Problem:
    """The job was erased during the attempt, or somebody emptied the storage by hand."""
    return problem(
        "fit-failed",
        code="input-gone",
        detail="What the job was made of is gone.",
        remedy="Post it again.",
    )


def no_storage(error: BlobsUnavailableError) -> Problem:
    """The storage was full or unavailable for longer than the worker waits."""
    full = isinstance(error, StorageFullError)
    return problem(
        "fit-failed",
        code="storage-full" if full else "storage-unavailable",
        detail="The result could not be stored.",
        remedy="Post it again once the service reports itself ready.",
    )


def no_process() -> Problem:
    """The machine had no room for a process for longer than the worker waits."""
    return problem(
        "fit-failed",
        code="no-process",
        detail="No process could be started for the job.",
        remedy="Post it again once the service reports itself ready.",
    )


def too_slow(limit_s: float) -> Problem:
    """The job exceeded its time limit."""
    return problem(
        "time-limit-exceeded",
        detail=f"The job was stopped after {limit_s:g} s.",
        remedy="Send a smaller picture, choose the optimizer gauss_newton, or ask for less.",
    )
