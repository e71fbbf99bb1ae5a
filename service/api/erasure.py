"""Erasing what lay behind a record that is gone."""

from collections.abc import Iterable

from api_schemas.problems import problem
from service.api.problems import ProblemError
from service.blobs import BlobStore, BlobsUnavailableError


def erase_blobs(blobs: BlobStore, scopes: Iterable[str]) -> None:
    """Erase scopes whose records are gone.

    Raises
    ------
    ProblemError
        If the storage is unavailable: the sweep erases them once it is back.
    """
    try:
        for scope in scopes:
            blobs.erase(scope)
    except BlobsUnavailableError as error:
        raise ProblemError(
            problem(
                "not-ready",
                code="storage-unavailable",
                detail="It is not found any more, but the storage is not available: its files are "
                "erased once that is back.",
                remedy="Nothing has to be sent again.",
            )
        ) from error
