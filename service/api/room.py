"""No room: new work is refused while less disk is free than is reserved for running jobs."""

import contextlib
from collections.abc import Iterator
from typing import Final

from api_schemas.problems import problem
from service.api.problems import ProblemError
from service.blobs import StorageFullError
from service.engine.port import EngineFullError

RETRY_AFTER_S: Final = 60
"""Somebody has to make room first."""


def no_room() -> ProblemError:
    """Say that nothing can be stored now."""
    return ProblemError(
        problem(
            "insufficient-storage",
            code="disk-full",
            detail="Too little of the disk is free; nothing was kept.",
            remedy="Erase what you need no more by DELETE, or try again after the time in "
            "Retry-After.",
        ),
        headers={"Retry-After": str(RETRY_AFTER_S)},
    )


@contextlib.contextmanager
def storing() -> Iterator[None]:
    """Say so too if the disk fills up while storing."""
    try:
        yield
    except (StorageFullError, EngineFullError) as error:
        raise no_room() from error
