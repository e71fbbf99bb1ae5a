"""OpenAPI links: how the operations lead from one to another."""

from collections.abc import Mapping
from typing import Any, Final

from service.api.job_resources import FITS, OF_FITS, OF_SCANS, SCANS, JobResource
from service.engine.port import FIT, SCAN

Links = Mapping[tuple[str, str], dict[str, Any]]
"""By operation and status."""

_BELOW: Final = {FIT: OF_FITS, SCAN: OF_SCANS}
_FIRST_PICTURE: Final[Mapping[str, Mapping[str, str]]] = {FIT: {}, SCAN: {"number": "0"}}

_FIRST_FILE: Final = {"name": "$response.body#/artifacts/0/name"}
_FROM_IMAGE: Final = {"image_id": "$response.body#/id"}
_SAME_IMAGE: Final = {"image_id": "$request.path.image_id"}


def _links(parameters: Mapping[str, str], *operations: str) -> dict[str, Any]:
    return {
        operation: {"operationId": operation, "parameters": dict(parameters)}
        for operation in operations
    }


def _of_jobs(of: JobResource) -> dict[tuple[str, str], dict[str, Any]]:
    """Those from the operations on fits, on scans or on what is derived from one of them."""
    names = of.operations
    answered = {of.parameter: "$response.body#/id"}
    same = {of.parameter: f"$request.path.{of.parameter}"}
    if of.parent is not None:
        made_of = f"{of.root}_id"
        answered[made_of] = f"$response.body#/{made_of}"
        same[made_of] = f"$request.path.{made_of}"

    begun = _links_to(of, answered, "get", "follow", "cancel", "erase", "request")
    ended = begun | _links_to(of, answered, "retry", "result")
    known = _links_to(of, same, "get", "follow", "cancel", "erase", "request", "retry", "result")
    if of.parent is None:
        below = [_BELOW[of.root].operations[each] for each in ("submit", "list")]
        begun |= _pictures(of, answered)
        ended |= _pictures(of, answered) | _links(answered, *below)
        known |= _pictures(of, same) | _links(same, *below)
    return {
        (names["submit"], "202"): begun,
        (names["submit"], "200"): ended,
        (names["retry"], "202"): begun,
        (names["retry"], "200"): ended,
        (names["get"], "200"): known,
        (names["cancel"], "200"): _links_to(of, same, "get", "retry", "erase"),
        (names["cancel"], "202"): _links_to(of, same, "get", "follow", "erase"),
        (names["result"], "200"): _links_to(of, same | _FIRST_FILE, "artifact"),
    }


def _links_to(of: JobResource, parameters: Mapping[str, str], *done: str) -> dict[str, Any]:
    return _links(parameters, *(of.operations[each] for each in done))


def _pictures(of: JobResource, parameters: Mapping[str, str]) -> dict[str, Any]:
    return _links_to(of, {**parameters, **_FIRST_PICTURE[of.root]}, "image", "mask")


LINKS: Final[Links] = {
    link: leads for of in (FITS, SCANS, OF_FITS, OF_SCANS) for link, leads in _of_jobs(of).items()
} | {
    ("upload_image", "200"): _links(_FROM_IMAGE, "get_image", "get_picture", "erase_image"),
    ("upload_image", "201"): _links(_FROM_IMAGE, "get_image", "get_picture", "erase_image"),
    ("get_image", "200"): _links(_SAME_IMAGE, "erase_image"),
}
