"""Why an attempt ended that its child did not end itself, as callers are told."""

from api_schemas.problems import Problem, problem
from service.blobs import BlobsUnavailableError, StorageFullError


def input_gone() -> Problem:
    """The job was erased under the attempt, or somebody emptied the storage by hand."""
    return problem(
        "fit-failed",
        code="input-gone",
        detail="The stored picture is gone.",
        remedy="Post the picture again.",
    )


def no_storage(error: BlobsUnavailableError) -> Problem:
    """The storage was full or away for longer than anybody waits."""
    full = isinstance(error, StorageFullError)
    return problem(
        "fit-failed",
        code="storage-full" if full else "storage-unavailable",
        detail="The result could not be stored.",
        remedy="Post the picture again once the service reports itself ready.",
    )


def no_process() -> Problem:
    """The machine has had no room for a process for longer than anybody waits."""
    return problem(
        "fit-failed",
        code="no-process",
        detail="No process could be started for the fit.",
        remedy="Post the picture again once the service reports itself ready.",
    )


def too_slow(limit_s: float) -> Problem:
    """The fit took longer than a fit may."""
    return problem(
        "time-limit-exceeded",
        detail=f"The fit was stopped after {limit_s:g} s.",
        remedy="Send a smaller picture, or choose the optimizer gauss_newton.",
    )
