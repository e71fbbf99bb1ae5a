"""What no schema tells schemathesis: bytes that are a picture, and points that lie inside it.

Fuzzing sends what the schema alone would have, and so do all forms; the JSON bodies of the other
phases are made acceptable, so that these come to the jobs behind. ``schemathesis.toml`` names this
module as its hooks.
"""

import hashlib
import os
import re
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

SIZE: dict[str, Any] = {
    "chart": {"sizes": [{"label": "M", "measurements": {"hip_girth": {"low": 94, "high": 98}}}]},
    "chart_csv": None,
    "ease": {},
    "tolerances": {},
}
"""A chart in order, with what goes with it."""

FIT = "CONTRACT_FIT"
DERIVATION = "CONTRACT_DERIVATION"
"""Variables with the ids of a fit that has succeeded and of a pose derived from it."""

DERIVATIONS = "/v1/fits/{fit_id}/derivations"

BY_ID = {"image_id": hashlib.sha256(UPLOADED).hexdigest(), "mask_id": None}


@schemathesis.hook
def before_call(context: HookContext, case: Case, kwargs: dict[str, Any]) -> None:
    """Make what is meant to be accepted acceptable, and have what is meant to be found be there."""
    del context, kwargs
    if not _is_meant_well(case):
        return
    # The same key with another request is refused, and rightly so.
    case.headers.pop("idempotency-key", None)
    operation = (case.method, case.operation.path)
    if operation == ("POST", DERIVATIONS):
        case.path_parameters["fit_id"] = os.environ[FIT]
    elif (
        case.method == "GET"
        and case.operation.path.startswith(DERIVATIONS)
        and _phase(case) is not TestPhase.STATEFUL
    ):
        known = {"fit_id": os.environ[FIT], "derivation_id": os.environ[DERIVATION]}
        case.path_parameters |= {name: known.get(name, "pose.png") for name in _named(case)}
    if case.media_type != "application/json" or not isinstance(case.body, dict):
        return
    if operation in (("POST", "/v1/fits"), ("POST", DERIVATIONS)):
        changes = ACCEPTED | BY_ID if case.operation.path == "/v1/fits" else {"webhook": None}
        if case.body.get("kind") == "size":
            changes |= SIZE
        case.body = case.body | changes


def _named(case: Case) -> list[str]:
    return re.findall(r"{(\w+)}", case.operation.path)


def _phase(case: Case) -> TestPhase | None:
    return None if case.meta is None else case.meta.phase.name


def _is_meant_well(case: Case) -> bool:
    meta = case.meta
    return (
        meta is not None
        and meta.phase.name is not TestPhase.FUZZING
        and meta.generation.mode is GenerationMode.POSITIVE
        and all(part.mode is GenerationMode.POSITIVE for part in meta.components.values())
    )
