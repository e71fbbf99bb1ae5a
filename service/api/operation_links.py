"""OpenAPI links: how the operations lead from one to another."""

from collections.abc import Mapping
from typing import Any, Final

Links = Mapping[tuple[str, str], dict[str, Any]]
"""By operation and status."""

_FROM_FIT: Final = {"fit_id": "$response.body#/id"}
_SAME_FIT: Final = {"fit_id": "$request.path.fit_id"}
_FIRST_FILE: Final = {"name": "$response.body#/files/0/name"}
_FROM_IMAGE: Final = {"image_id": "$response.body#/id"}
_SAME_IMAGE: Final = {"image_id": "$request.path.image_id"}

_OF_ACTIVE: Final = ("get_fit", "follow_fit", "cancel_fit", "erase_fit", "get_fit_request")


def _links(parameters: Mapping[str, str], *operations: str) -> dict[str, Any]:
    return {
        operation: {"operationId": operation, "parameters": dict(parameters)}
        for operation in operations
    }


LINKS: Final[Links] = {
    ("submit_fit", "202"): _links(_FROM_FIT, *_OF_ACTIVE),
    ("submit_fit", "200"): _links(_FROM_FIT, *_OF_ACTIVE, "get_fit_result"),
    ("get_fit", "200"): _links(_SAME_FIT, *_OF_ACTIVE, "get_fit_result"),
    ("cancel_fit", "200"): _links(_SAME_FIT, "get_fit", "erase_fit"),
    ("cancel_fit", "202"): _links(_SAME_FIT, "get_fit", "follow_fit", "erase_fit"),
    ("get_fit_result", "200"): _links(_SAME_FIT | _FIRST_FILE, "get_fit_file"),
    ("upload_image", "200"): _links(_FROM_IMAGE, "get_image", "get_picture", "erase_image"),
    ("upload_image", "201"): _links(_FROM_IMAGE, "get_image", "get_picture", "erase_image"),
    ("get_image", "200"): _links(_SAME_IMAGE, "erase_image"),
}
