"""Problems for attempts that no pipeline ended, as reported to callers."""

from api_schemas.problems import Problem, problem
from service.jobs.blobs import BlobsUnavailableError, StorageFullError
from service.jobs.records import Ending


def ending_by(reason: Problem) -> Ending:
    """How an attempt ended whose process told of this problem."""
    is_late = reason.type == too_slow(0.0).type
    return Ending.TIMED_OUT if is_late else Ending.FAILED


def fault() -> Problem:
    """Something is wrong with the service itself."""
    return problem(
        "fit-failed",
        detail="An unexpected fault ended the job.",
        remedy="Report it with the job's id; other jobs are not affected.",
    )


def out_of_memory() -> Problem:
    """The job met the limit of its process."""
    return problem(
        "fit-failed",
        code="out-of-memory",
        detail="The job needed more memory than one job may have.",
        remedy="Send a smaller picture, or ask for less at once.",
    )


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
