"""OpenAPI links: how the operations lead from one to another."""

from collections.abc import Mapping
from typing import Any, Final

_FIT: Final = ("get_fit", "follow", "cancel", "erase", "fit_image", "fit_mask", "fit_request")
_ENDED_FIT: Final = (*_FIT, "retry", "result", "derive", "list_derivations")
_DERIVATION: Final = (
    "get_derivation",
    "follow_derivation",
    "cancel_derivation",
    "erase_derivation",
    "derivation_request",
)
_ENDED_DERIVATION: Final = (*_DERIVATION, "retry_derivation", "derivation_result")

_FROM_JOB: Final = {"fit_id": "$response.body#/id"}
_SAME_FIT: Final = {"fit_id": "$request.path.fit_id"}
_FROM_DERIVATION: Final = {
    "fit_id": "$response.body#/fit_id",
    "derivation_id": "$response.body#/id",
}
_SAME_DERIVATION: Final = _SAME_FIT | {"derivation_id": "$request.path.derivation_id"}
_FROM_IMAGE: Final = {"image_id": "$response.body#/id"}
_FROM_TOKEN: Final = {"token_id": "$response.body#/id"}
_SAME_TOKEN: Final = {"token_id": "$request.path.token_id"}
_SAME_IMAGE: Final = {"image_id": "$request.path.image_id"}


def _links(parameters: Mapping[str, str], *operations: str) -> dict[str, Any]:
    return {
        operation: {"operationId": operation, "parameters": dict(parameters)}
        for operation in operations
    }


_SCAN: Final = ("get_scan", "follow_scan", "cancel_scan", "erase_scan", "scan_request")
_VIEWS: Final = ("scan_image", "scan_mask")
_ENDED_SCAN: Final = (
    *_SCAN,
    "retry_scan",
    "scan_result",
    "derive_of_scan",
    "list_derivations_of_scan",
)


def _of_scan(*operations: str) -> tuple[str, ...]:
    return tuple(f"{operation}_of_scan" for operation in operations)


_FROM_SCAN: Final = {"scan_id": "$response.body#/id"}
_SAME_SCAN: Final = {"scan_id": "$request.path.scan_id"}
_FROM_SCAN_DERIVATION: Final = {
    "scan_id": "$response.body#/scan_id",
    "derivation_id": "$response.body#/id",
}
_SAME_SCAN_DERIVATION: Final = _SAME_SCAN | {"derivation_id": "$request.path.derivation_id"}
_FIRST_VIEW: Final = {"number": "0"}
_FIRST_FILE: Final = {"name": "$response.body#/artifacts/0/name"}


def _scan_links(parameters: Mapping[str, str], *operations: str) -> dict[str, Any]:
    return _links(parameters, *operations) | _links({**parameters, **_FIRST_VIEW}, *_VIEWS)


LINKS: Final[Mapping[tuple[str, str], dict[str, Any]]] = {
    ("submit", "202"): _links(_FROM_JOB, *_FIT),
    ("submit", "200"): _links(_FROM_JOB, *_ENDED_FIT),
    ("retry", "202"): _links(_FROM_JOB, *_FIT),
    ("retry", "200"): _links(_FROM_JOB, *_ENDED_FIT),
    ("get_fit", "200"): _links(_SAME_FIT, *_ENDED_FIT),
    ("cancel", "200"): _links(_SAME_FIT, "get_fit", "retry", "erase"),
    ("cancel", "202"): _links(_SAME_FIT, "get_fit", "follow", "erase"),
    ("result", "200"): _links(_SAME_FIT | {"name": "$response.body#/artifacts/0/name"}, "artifact"),
    ("derive", "202"): _links(_FROM_DERIVATION, *_DERIVATION),
    ("derive", "200"): _links(_FROM_DERIVATION, *_ENDED_DERIVATION),
    ("retry_derivation", "202"): _links(_FROM_DERIVATION, *_DERIVATION),
    ("retry_derivation", "200"): _links(_FROM_DERIVATION, *_ENDED_DERIVATION),
    ("get_derivation", "200"): _links(_SAME_DERIVATION, *_ENDED_DERIVATION),
    ("cancel_derivation", "200"): _links(
        _SAME_DERIVATION, "get_derivation", "retry_derivation", "erase_derivation"
    ),
    ("cancel_derivation", "202"): _links(_SAME_DERIVATION, "get_derivation", "erase_derivation"),
    ("derivation_result", "200"): _links(
        _SAME_DERIVATION | {"name": "$response.body#/artifacts/0/name"}, "derivation_artifact"
    ),
    ("submit_scan", "202"): _scan_links(_FROM_SCAN, *_SCAN),
    ("submit_scan", "200"): _scan_links(_FROM_SCAN, *_ENDED_SCAN),
    ("retry_scan", "202"): _scan_links(_FROM_SCAN, *_SCAN),
    ("retry_scan", "200"): _scan_links(_FROM_SCAN, *_ENDED_SCAN),
    ("get_scan", "200"): _scan_links(_SAME_SCAN, *_ENDED_SCAN),
    ("cancel_scan", "200"): _links(_SAME_SCAN, "get_scan", "retry_scan", "erase_scan"),
    ("cancel_scan", "202"): _links(_SAME_SCAN, "get_scan", "follow_scan", "erase_scan"),
    ("scan_result", "200"): _links(_SAME_SCAN | _FIRST_FILE, "scan_artifact"),
    ("derive_of_scan", "202"): _links(_FROM_SCAN_DERIVATION, *_of_scan(*_DERIVATION)),
    ("derive_of_scan", "200"): _links(_FROM_SCAN_DERIVATION, *_of_scan(*_ENDED_DERIVATION)),
    ("retry_derivation_of_scan", "202"): _links(_FROM_SCAN_DERIVATION, *_of_scan(*_DERIVATION)),
    ("retry_derivation_of_scan", "200"): _links(
        _FROM_SCAN_DERIVATION, *_of_scan(*_ENDED_DERIVATION)
    ),
    ("get_derivation_of_scan", "200"): _links(_SAME_SCAN_DERIVATION, *_of_scan(*_ENDED_DERIVATION)),
    ("cancel_derivation_of_scan", "200"): _links(
        _SAME_SCAN_DERIVATION,
        *_of_scan("get_derivation", "retry_derivation", "erase_derivation"),
    ),
    ("cancel_derivation_of_scan", "202"): _links(
        _SAME_SCAN_DERIVATION, *_of_scan("get_derivation", "erase_derivation")
    ),
    ("derivation_result_of_scan", "200"): _links(
        _SAME_SCAN_DERIVATION | _FIRST_FILE, *_of_scan("derivation_artifact")
    ),
    ("upload_image", "200"): _links(_FROM_IMAGE, "get_image", "get_picture", "erase_image"),
    ("upload_image", "201"): _links(_FROM_IMAGE, "get_image", "get_picture", "erase_image"),
    ("get_image", "200"): _links(_SAME_IMAGE, "erase_image"),
    ("make_token", "201"): _links(_FROM_TOKEN, "get_token", "revoke_token"),
    ("get_token", "200"): _links(_SAME_TOKEN, "revoke_token"),
}
"""By operation and status."""
