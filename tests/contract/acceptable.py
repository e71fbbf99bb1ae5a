"""What no schema tells schemathesis: bytes that are a picture, and points that lie inside it.

Fuzzing sends what the schema alone would have; what the other phases ask of fits is made
acceptable, so that these come to the jobs behind. ``schemathesis.toml`` names this module as its
hooks.
"""

import hashlib
from typing import Any

import schemathesis
from hypothesis import strategies as st
from schemathesis import Case, GenerationMode, HookContext
from schemathesis.generation.meta import TestPhase

from service.api.openapi import recorded_examples
from tests.integration.service.fake_pipeline import scripted_image

POINTS = recorded_examples()["requests"]["submit_fit"]["uploaded-picture"]["views"][0]["points"]

PICTURES = [
    scripted_image(script, width=720, height=960)
    for script in ({}, {"seconds": 0.5}, {"unusable": True})
]
UPLOADED = PICTURES[0]
"""Uploaded before the run."""

schemathesis.openapi.media_type(
    "image/png", st.sampled_from(PICTURES), aliases=["image/jpeg", "image/webp", "image/heic"]
)

BY_ID = {"image_id": hashlib.sha256(UPLOADED).hexdigest(), "mask_id": None}

ACCEPTED: dict[str, Any] = {
    "weight_kg": None,
    "measurements": {},
    "paper": None,
    "webhook": None,
    "views": [{"view": view, "points": POINTS, **BY_ID} for view in ("front", "side")],
}
"""Of what is related to something else, one value that goes with anything."""


@schemathesis.hook
def before_call(context: HookContext, case: Case, kwargs: dict[str, Any]) -> None:
    """Make what is meant to be accepted acceptable, and have what is meant to be found be there."""
    del context, kwargs
    if not _is_meant_well(case):
        return
    # The same key with another request is refused, and rightly so.
    case.headers.pop("idempotency-key", None)
    asked = case.body.get("request") if isinstance(case.body, dict) else None
    if (case.method, case.operation.path) == ("POST", "/v1/fits") and isinstance(asked, dict):
        case.body = {"request": asked | ACCEPTED}


def _is_meant_well(case: Case) -> bool:
    meta = case.meta
    return (
        meta is not None
        and meta.phase.name is not TestPhase.FUZZING
        and meta.generation.mode is GenerationMode.POSITIVE
        and all(part.mode is GenerationMode.POSITIVE for part in meta.components.values())
    )
