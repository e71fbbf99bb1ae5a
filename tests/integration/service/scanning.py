"""Scans as callers submit them, of scripted pictures."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import httpx
import pytest

from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import POINTS, REQUEST, Service

FRONT: dict[str, Any] = {"view": "front", "points": POINTS}
SIDE: dict[str, Any] = {"view": "side", "points": POINTS}
SCAN: dict[str, Any] = {"gender": "male", "height_m": 1.8, "views": [FRONT, SIDE]}

Script = dict[str, object]


def files_of(
    images: Sequence[bytes], masks: Mapping[int, bytes] | None = None
) -> dict[str, tuple[str, bytes, str]]:
    """The parts of a form that are pictures and masks."""
    parts = {f"image_{number}": image for number, image in enumerate(images)}
    parts |= {f"mask_{number}": mask for number, mask in (masks or {}).items()}
    return {name: (name, content, "image/png") for name, content in parts.items()}


def post_scan(
    service: Service,
    *scripts: Script,
    request: Mapping[str, Any] = SCAN,
    images: Sequence[bytes] | None = None,
    masks: Mapping[int, bytes] | None = None,
    **headers: str,
) -> httpx.Response:
    """Post pictures that do what these scripts say, or two that say nothing."""
    if images is None:
        images = [scripted_image(script) for script in scripts or ({}, {"n": 1})]
    return service.client.post(
        "/v1/scans",
        files=files_of(images, masks),
        data={"request": json.dumps(request)},
        headers=headers,
    )


def posted(
    service: Service,
    resource: str,
    script: Script | None = None,
    said: Mapping[str, Any] | None = None,
    **headers: str,
) -> httpx.Response:
    """Post a picture as a fit, or with another as a scan, that does what the script says.

    ``said`` is said of either beside what all requests say.
    """
    if resource == "fits":
        return service.post(script, request=REQUEST | (said or {}), headers=headers)
    return post_scan(service, script or {}, {"n": 1}, request=SCAN | dict(said or {}), **headers)


def submitted(
    service: Service,
    resource: str,
    script: Script | None = None,
    said: Mapping[str, Any] | None = None,
) -> str:
    """Post so, and return the job's path."""
    answer = posted(service, resource, script, said)
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


of_either = pytest.mark.parametrize("resource", ["fits", "scans"])
"""What holds for fits and scans alike is tested of both."""


def submit_scan(service: Service, *scripts: Script, **options: Any) -> str:
    """Post and return the job's path."""
    answer = post_scan(service, *scripts, **options)
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


def scanned(service: Service, *scripts: Script, **options: Any) -> str:
    """Have a scan made, and return its path."""
    path = submit_scan(service, *scripts, **options)
    assert service.ended(path)["state"] == "succeeded"
    return path
