"""No caller of a released version is broken unless the version says so; the comparer is awake."""

import copy
import json
from collections.abc import Callable

import pytest

from tests.contract.compatibility import breaking_changes, may_break
from tests.contract.document import FOLDER, Document, exported


def version(document: Document) -> tuple[int, ...]:
    return tuple(map(int, document["info"]["version"].split(".")))


RELEASED = [json.loads(file.read_text()) for file in (FOLDER / "released").glob("openapi-*.json")]
NEWEST = max(RELEASED, key=version)
RENAMED = {
    "submit": "submit_fit",
    "erase": "erase_fit",
    "cancel": "cancel_fit",
    "follow": "follow_fit",
    "result": "get_fit_result",
    "artifact": "get_fit_artifact",
    "retry": "retry_fit",
    "fit_image": "get_fit_image",
    "fit_mask": "get_fit_mask",
    "fit_request": "get_fit_request",
    "scan_request": "get_scan_request",
    "scan_image": "get_scan_image",
    "scan_mask": "get_scan_mask",
    "scan_result": "get_scan_result",
    "scan_artifact": "get_scan_artifact",
    "derive": "submit_fit_derivation",
    "list_derivations": "list_fit_derivations",
    "retry_derivation": "retry_fit_derivation",
    "get_derivation": "get_fit_derivation",
    "erase_derivation": "erase_fit_derivation",
    "cancel_derivation": "cancel_fit_derivation",
    "follow_derivation": "follow_fit_derivation",
    "derivation_request": "get_fit_derivation_request",
    "derivation_result": "get_fit_derivation_result",
    "derivation_artifact": "get_fit_derivation_artifact",
    "derive_of_scan": "submit_scan_derivation",
    "list_derivations_of_scan": "list_scan_derivations",
    "retry_derivation_of_scan": "retry_scan_derivation",
    "get_derivation_of_scan": "get_scan_derivation",
    "erase_derivation_of_scan": "erase_scan_derivation",
    "cancel_derivation_of_scan": "cancel_scan_derivation",
    "follow_derivation_of_scan": "follow_scan_derivation",
    "derivation_request_of_scan": "get_scan_derivation_request",
    "derivation_result_of_scan": "get_scan_derivation_result",
    "derivation_artifact_of_scan": "get_scan_derivation_artifact",
    "initial_pose": "estimate_initial_pose",
    "body_models": "list_body_models",
    "live": "get_liveness",
    "ready": "get_readiness",
    "metrics": "get_metrics",
    "problem_type": "get_problem_type",
}
"""Operations that clients generated from the newest release call otherwise."""


def test_released_documents_are_named_by_their_versions():
    names = {file.name for file in (FOLDER / "released").iterdir()}
    assert names == {f"openapi-{each['info']['version']}.json" for each in RELEASED}
    assert version(exported()) >= version(NEWEST)


def test_callers_of_the_newest_release_are_not_broken_unless_the_version_says_so():
    changes = breaking_changes(NEWEST, exported(), renamed=RENAMED)
    assert changes == [] or may_break(NEWEST, exported()), "raise VERSION, or take them back"


def test_nothing_breaks_where_nothing_changes():
    assert breaking_changes(exported(), exported()) == []


def schemas(document: Document) -> dict:
    return document["components"]["schemas"]


def submit(document: Document) -> dict:
    return document["paths"]["/v1/fits"]["post"]


def narrowed(document: Document, name: str, field: str, **changes: object) -> None:
    schemas(document)[name]["properties"][field] |= changes


def renamed_operation(document: Document) -> None:
    submit(document)["operationId"] = "post_fit"


def tightened_union(document: Document) -> None:
    height = schemas(document)["FitRequest"]["properties"]["height_m"]
    height["anyOf"] = [kind for kind in height["anyOf"] if kind != {"type": "null"}]


def widened_answer(document: Document) -> None:
    schemas(document)["Job"]["properties"]["progress"] = {"type": ["number", "null"]}


BREAKING: dict[str, tuple[Callable[[Document], object], str]] = {
    "path": (lambda d: d["paths"].pop("/v1/bodies"), "POST /v1/bodies is gone"),
    "operation": (lambda d: d["paths"]["/v1/fits/{fit_id}"].pop("delete"), "DELETE"),
    "operation renamed": (renamed_operation, "post_fit"),
    "status": (lambda d: submit(d)["responses"].pop("200"), "200 is gone"),
    "header": (
        lambda d: d["components"]["responses"]["submit_fit.202"]["headers"].pop("Location"),
        "Location",
    ),
    "parameter": (lambda d: submit(d)["parameters"].pop(0), "idempotency-key is gone"),
    "parameter needed": (
        lambda d: d["components"]["parameters"]["idempotency-key"].update(required=True),
        "idempotency-key is required",
    ),
    "media type sent": (
        lambda d: submit(d)["requestBody"]["content"].pop("multipart/form-data"),
        "multipart/form-data is gone",
    ),
    "media type answered": (
        lambda d: d["paths"]["/v1/bodies"]["post"]["responses"]["200"]["content"].pop(
            "model/gltf-binary"
        ),
        "model/gltf-binary is gone",
    ),
    "answered field": (
        lambda d: schemas(d)["Job"]["properties"].pop("progress"),
        ".progress is gone",
    ),
    "answered field optional": (
        lambda d: schemas(d)["Job"]["required"].remove("state"),
        ".state may be missing",
    ),
    "answered value gone": (
        lambda d: schemas(d)["JobState"]["enum"].remove("timed_out"),
        "'timed_out' is gone",
    ),
    "answered value new": (
        lambda d: schemas(d)["JobState"]["enum"].append("paused"),
        "'paused' is not in both",
    ),
    "answered type wider": (widened_answer, ".progress:"),
    "accepted field": (
        lambda d: schemas(d)["FitRequest"]["properties"].pop("cues"),
        ".cues is gone",
    ),
    "accepted value": (lambda d: schemas(d)["Cues"]["enum"].remove("SE"), "'SE' is not in both"),
    "new needed field": (
        lambda d: schemas(d)["BodyRequest"]["required"].append("height_m"),
        ".height_m is required",
    ),
    "null no longer accepted": (tightened_union, "height_m"),
    "narrower bound": (
        lambda d: narrowed(d, "ImageSize", "width", maximum=10),
        "image_size: no more ImageSize",
    ),
    "answered type": (
        lambda d: schemas(d)["PartRotation"]["properties"]["part"].update(type="integer"),
        ".part:",
    ),
    "notice's field": (
        lambda d: schemas(d)["WebhookEvent"]["properties"].pop("timestamp"),
        ".timestamp is gone",
    ),
    "event's field": (
        lambda d: schemas(d)["EventData"]["properties"].pop("progress"),
        "text/event-stream.items.data.contentSchema.progress is gone",
    ),
}


@pytest.mark.parametrize(("change", "said"), BREAKING.values(), ids=BREAKING)
def test_what_breaks_callers_is_named(change: Callable[[Document], object], said: str):
    changed = exported()
    change(changed)
    found = breaking_changes(exported(), changed)
    assert any(said in each for each in found), found


def test_what_operations_share_is_compared_behind_its_reference():
    changed = exported()
    not_found = changed["components"]["responses"]["not-found"]["content"]
    not_found["text/plain"] = not_found.pop("application/problem+json")
    changed["components"]["parameters"]["limit"]["name"] = "most"
    found = breaking_changes(NEWEST, changed, renamed=RENAMED)
    assert any("404 application/problem+json is gone" in each for each in found), found
    assert any("parameter limit is gone" in each for each in found), found


def test_events_are_compared_with_those_of_the_newest_release():
    changed = exported()
    schemas(changed)["EventData"]["properties"].pop("progress")
    found = breaking_changes(NEWEST, changed)
    assert any("text/event-stream" in each for each in found), found


def test_bounds_of_heights_are_compared_with_those_of_the_newest_release():
    changed = exported()
    narrower = schemas(changed)["FitRequest"]["properties"]["height_m"]["anyOf"][0]
    assert narrower["minimum"] == 1.2
    narrower["minimum"] = 1.5
    found = breaking_changes(NEWEST, changed)
    assert any("height_m" in each for each in found), found


def new_path(document: Document) -> None:
    document["paths"]["/v1/new"] = copy.deepcopy(document["paths"]["/v1/bodies"])


def new_fields(document: Document) -> None:
    for name in ("Job", "FitRequest"):
        schemas(document)[name]["properties"]["note"] = {"type": "string"}


def new_accepted_value(document: Document) -> None:
    (slug,) = document["paths"]["/problems/{slug}"]["get"]["parameters"]
    slug["schema"]["enum"].append("new-problem")


HARMLESS: dict[str, Callable[[Document], object]] = {
    "new path": new_path,
    "new optional fields": new_fields,
    "new status": lambda d: submit(d)["responses"].update({"418": {"description": "No."}}),
    "new accepted value": new_accepted_value,
    "wider bound": lambda d: narrowed(d, "ImageSize", "width", maximum=10**9),
    "other words": lambda d: schemas(d)["Job"].update(description="A job."),
    "an answer that is always there": lambda d: schemas(d)["Job"]["required"].append("expires_at"),
}


@pytest.mark.parametrize("change", HARMLESS.values(), ids=HARMLESS)
def test_additions_break_nobody(change: Callable[[Document], object]):
    changed = exported()
    change(changed)
    assert breaking_changes(exported(), changed) == []


@pytest.mark.parametrize(
    ("before", "after", "allowed"),
    [
        ("1.0.0", "2.0.0", True),
        ("1.9.9", "1.10.0", False),
        ("1.0.0", "1.0.1", False),
        ("0.1.0", "0.2.0", True),
        ("0.1.0", "0.1.1", False),
        ("0.9.0", "1.0.0", True),
    ],
)
def test_only_a_major_version_may_break_and_a_minor_one_before_the_first(before, after, allowed):
    documents = [{"info": {"version": each}} for each in (before, after)]
    assert may_break(*documents) is allowed
