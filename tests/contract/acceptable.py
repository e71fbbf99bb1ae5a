"""What no schema tells schemathesis: bytes that are a picture, and points that lie inside it.

Fuzzing sends what the schema alone would have, and so do all forms; the JSON bodies of the other
phases are made acceptable, so that these come to the jobs behind. ``schemathesis.toml`` names this
module as its hooks.
"""

import hashlib
from typing import Any

import schemathesis
from hypothesis import strategies as st
from schemathesis import Case, GenerationMode, HookContext
from schemathesis.generation.meta import TestPhase

from service.api.examples.estimates import POINTS
from tests.integration.service.fake_pipeline import scripted_image

PICTURES = [
    scripted_image(script, width=720, height=960)
    for script in ({}, {"seconds": 0.5}, {"unusable": True})
]
UPLOADED = PICTURES[0]
"""Uploaded before the run."""

schemathesis.openapi.media_type(
    "image/png", st.sampled_from(PICTURES), aliases=["image/jpeg", "image/webp"]
)

ACCEPTED: dict[str, Any] = {
    "points": POINTS,
    "format": "named",
    "weight_kg": None,
    "measurements": {},
    "focal_length_px": None,
    "webhook": None,
}
"""Of what is related to something else, one value that goes with anything."""

BY_ID = {"image_id": hashlib.sha256(UPLOADED).hexdigest(), "mask_id": None}


@schemathesis.hook
def before_call(context: HookContext, case: Case, kwargs: dict[str, Any]) -> None:
    """Make a submission that is meant to be accepted acceptable."""
    del context, kwargs
    if (case.method, case.operation.path) != ("POST", "/v1/fits") or not _is_to_be_accepted(case):
        return
    # The same key with another body is refused, and rightly so.
    case.headers.pop("idempotency-key", None)
    case.body = case.body | ACCEPTED | BY_ID


def _is_to_be_accepted(case: Case) -> bool:
    meta = case.meta
    return (
        meta is not None
        and case.media_type == "application/json"
        and isinstance(case.body, dict)
        and meta.phase.name is not TestPhase.FUZZING
        and meta.generation.mode is GenerationMode.POSITIVE
        and all(part.mode is GenerationMode.POSITIVE for part in meta.components.values())
    )
