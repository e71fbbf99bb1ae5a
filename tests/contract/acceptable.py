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

from service.api.openapi import recorded_examples
from tests.integration.service.fake_pipeline import scripted_image

POINTS = recorded_examples()["requests"]["submit_fit"]["uploaded-picture"]["points"]

PICTURES = [
    scripted_image(script, width=720, height=960)
    for script in ({}, {"seconds": 0.5}, {"unusable": True})
]
UPLOADED = PICTURES[0]
"""Uploaded before the run."""

schemathesis.openapi.media_type(
    "image/png", st.sampled_from(PICTURES), aliases=["image/jpeg", "image/webp", "image/heic"]
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

SCAN = "CONTRACT_SCAN"
SCAN_DERIVATION = "CONTRACT_SCAN_DERIVATION"
"""The same of a scan."""

DERIVATIONS = {
    "/v1/fits/{fit_id}/derivations": ("fit_id", FIT, DERIVATION),
    "/v1/scans/{scan_id}/derivations": ("scan_id", SCAN, SCAN_DERIVATION),
}
"""Paths of derivations, with the parameter that names their parent and variables with the ids."""

BY_ID = {"image_id": hashlib.sha256(UPLOADED).hexdigest(), "mask_id": None}

SCANNED: dict[str, Any] = {
    "weight_kg": None,
    "measurements": {},
    "webhook": None,
    "views": [{"view": view, "points": POINTS, **BY_ID} for view in ("front", "side")],
}
"""A scan in order, whatever else is asked of it."""


@schemathesis.hook
def before_call(context: HookContext, case: Case, kwargs: dict[str, Any]) -> None:
    """Make what is meant to be accepted acceptable, and have what is meant to be found be there."""
    del context, kwargs
    if not _is_meant_well(case):
        return
    # The same key with another request is refused, and rightly so.
    case.headers.pop("idempotency-key", None)
    path = case.operation.path
    for below, (name, parent, derivation) in DERIVATIONS.items():
        if (case.method, path) == ("POST", below):
            case.path_parameters[name] = os.environ[parent]
        elif (
            case.method == "GET"
            and path.startswith(below)
            and _phase(case) is not TestPhase.STATEFUL
        ):
            known = {name: os.environ[parent], "derivation_id": os.environ[derivation]}
            case.path_parameters |= {each: known.get(each, "pose.png") for each in _named(case)}
    if case.media_type == "application/json" and isinstance(case.body, dict):
        case.body = case.body | _acceptable(case.method, path, case.body)


def _acceptable(method: str, path: str, body: dict[str, Any]) -> dict[str, Any]:
    """What is to be otherwise in a body for it to be accepted."""
    if method != "POST":
        return {}
    if path == "/v1/fits":
        return ACCEPTED | BY_ID
    if path == "/v1/scans":
        return SCANNED
    if path in DERIVATIONS:
        return {"webhook": None} | (SIZE if body.get("kind") == "size" else {})
    return {}


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
