"""A child reads what version 1.0 stored of a job as it reads what this version stores."""

import json
from typing import Any
from uuid import UUID

import pytest

from api_schemas.requests import FitOptions, FitRequest
from api_schemas.scans import ScanOptions, ScanRequest
from service.jobs.inputs import SANDBOX, SentPicture, named_pictures, pictures_of
from service.numerics.tasks import ChildSetup, Parts
from service.worker.tasks import DERIVED_FROM, OPTIONS, derivation_input, fit_input

PICTURE: dict[str, Any] = {
    "complete_points": False,
    "clothing": "tight",
    "segmentation": "seeded_grabcut",
    "slant_hints": True,
    "light": {
        "kind": "point",
        "azimuth_deg": None,
        "elevation_deg": None,
        "distance_m": None,
    },
    "focal_length_px": None,
    "focal_length_35mm": 26.0,
    "format": "named",
    "limb_facing": {"left_forearm": "toward"},
    "points": {"nose": {"x": 1.0, "y": 2.0, "visibility": 2, "source": "click"}},
}
PERSON: dict[str, Any] = {
    "height_m": 1.8,
    "weight_kg": None,
    "measurements": {"hip_girth": {"value": 98.0, "standard_error": 1.5}},
    "gender": "male",
    "cues": "SES",
    "force": False,
}
FIT_OF_1_0 = PICTURE | PERSON | {"optimizer": "gauss_newton"}
SCAN_OF_1_0 = PERSON | {"views": [PICTURE | {"view": view} for view in ("front", "side")]}

SETUP = ChildSetup(
    name="job",
    tasks="p",
    max_pixels=9,
    models=None,
    detector=None,
    memory_mb=1,
    log_level="INFO",
    log_format="text",
)


def given(options: dict[str, Any], inputs: dict[str, bytes]) -> Parts:
    return {OPTIONS: json.dumps(options).encode(), **inputs}


def test_a_fit_that_version_1_0_stored_is_run():
    job = fit_input(SETUP, given(FIT_OF_1_0, {"image": b"front", "mask": b"grey"}), FitOptions)
    assert job.pictures == (SentPicture(b"front", b"grey"),)
    (asked,) = job.options.pictures
    assert (asked.view, asked.focal_length_35mm, job.options.optimizer) == (
        None,
        26.0,
        "gauss_newton",
    )


def test_a_scan_that_version_1_0_stored_is_run():
    inputs = {"image_1": b"side", "image_0": b"front", "mask_1": b"grey"}
    job = fit_input(SETUP, given(SCAN_OF_1_0, inputs), ScanOptions)
    assert job.pictures == (SentPicture(b"front", None), SentPicture(b"side", b"grey"))
    assert [each.view for each in job.options.pictures] == ["front", "side"]
    assert job.options.optimizer == "gauss_newton"


@pytest.mark.parametrize("stored", [FIT_OF_1_0, SCAN_OF_1_0], ids=["fit", "scan"])
def test_what_this_version_stores_of_such_a_request_has_the_fields_of_version_1_0(stored):
    kind = ScanRequest if "views" in stored else FitRequest
    asked = kind.model_validate_json(json.dumps(stored))
    points = [each.points for each in asked.pictures]
    again = json.loads(asked.understood(points).model_dump_json())
    assert again.keys() == stored.keys()
    if isinstance(asked, ScanRequest):
        assert again["views"][0].keys() == stored["views"][0].keys()


def test_pictures_have_the_names_that_version_1_0_gave_them():
    front, side = SentPicture(b"f", None), SentPicture(b"s", b"m")
    assert named_pictures([side]) == {"image": b"s", "mask": b"m"}
    assert named_pictures([front, side]) == {"image_0": b"f", "image_1": b"s", "mask_1": b"m"}
    for pictures in ([side], [front, side], [front] * 6):
        assert pictures_of(named_pictures(pictures)) == tuple(pictures)


def test_how_a_sandbox_is_asked_to_end_a_job_reaches_the_pipeline():
    asked = given(FIT_OF_1_0, {"image": b"", SANDBOX: b"slow:5"})
    assert fit_input(SETUP, asked, FitOptions).ending == "slow:5"
    made_of = UUID(int=1)
    inputs = {DERIVED_FROM: str(made_of).encode(), "person.npz": b"p"}
    caricature = given({"kind": "caricature", "factor": 2.0}, inputs)
    derived = derivation_input(SETUP, caricature)
    assert (derived.fit_id, derived.ending, dict(derived.inputs)) == (
        made_of,
        None,
        {"person.npz": b"p"},
    )
