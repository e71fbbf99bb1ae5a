"""A real picture through the real service: Duerer's Adam of 1507, where the file is at hand."""

import json

import httpx
import numpy as np
import pytest
import trimesh

from tests.e2e.service import ended_job
from tests.shared_data import SHARED_DATA, needs_shared

PICTURE = SHARED_DATA / "real" / "durer_adam_1507.jpg"
DESCRIPTION = PICTURE.with_suffix(".json")

pytestmark = [needs_shared(PICTURE), needs_shared(DESCRIPTION)]


@pytest.fixture(scope="module")
def fit(service: httpx.Client) -> tuple[dict, dict[str, bytes]]:
    """The result document and the files of the fit."""
    described = json.loads(DESCRIPTION.read_text())
    request = {
        "gender": described["gender"],
        "height_m": described["height_m"],
        "views": [{"points": described["points"]}],
    }
    job = ended_job(
        service,
        service.post(
            "/v1/fits",
            files={"image": (PICTURE.name, PICTURE.read_bytes(), "image/jpeg")},
            data={"request": json.dumps(request)},
        ),
    )
    assert job["state"] == "succeeded", job["problem"]
    result = service.get(job["links"]["result"]).raise_for_status().json()
    files = {
        name: service.get(path).raise_for_status().content
        for name, path in job["links"]["files"].items()
    }
    return result, files


def posed_mesh(files: dict[str, bytes]) -> trimesh.Trimesh:
    scene = trimesh.load(
        trimesh.util.wrap_as_stream(files["views/0/body_posed.glb"]), file_type="glb", process=False
    )
    return next(iter(scene.geometry.values()))


def test_the_body_covers_the_painted_man(fit):
    result, _ = fit
    # His hair, a tenth of his outline, is the person's to a detector and no part of the body.
    (view,) = result["views"]
    assert view["silhouette_overlap"] > 0.85
    assert view["outcome"] == "converged"


def test_the_body_stands_upright(fit):
    _, files = fit
    vertices = np.asarray(posed_mesh(files).vertices)
    # The GLB is y up: a man leaning out of the picture is deeper than he is broad.
    extent = np.ptp(vertices, axis=0)
    assert 1.6 < extent[1] < 1.95
    assert extent[2] < 0.95


def test_the_raised_forearm_comes_toward_the_viewer(fit):
    result, _ = fit
    facing = {limb["limb"]: limb["facing"] for limb in result["views"][0]["limb_facing"]}
    assert facing["left_forearm"] == "toward"


def test_measurements_are_those_of_a_man(fit):
    result, _ = fit
    values = {m["name"]: m["value"] for m in result["measurements"]}
    assert values["stature"] == pytest.approx(182.0, abs=0.2)
    assert 60 < values["weight"] < 100
    assert 85 < values["chest_girth"] < 115
    assert 75 < values["waist_girth_navel"] < 108
    assert values["waist_girth_smallest"] <= values["waist_girth_navel"] + 0.1


def test_what_was_assumed_is_said(fit):
    result, _ = fit
    assert "lens-assumed" in {a["code"] for a in result["views"][0]["assumptions"]}


def test_the_light_comes_from_the_upper_left_as_painted(fit):
    result, _ = fit
    light = result["views"][0]["light"]
    assert light["azimuth_deg"] < 0.0
    assert light["elevation_deg"] > 0.0


def test_every_promised_file_is_there(fit):
    _, files = fit
    assert set(files) >= {
        "body_canonical.glb",
        "result.json",
        "views/0/body_posed.glb",
        "views/0/segmentation.png",
        "views/0/trimap.png",
        "views/0/overlay.png",
        "views/0/albedo.png",
        "views/0/shading.png",
    }


def test_the_result_file_is_the_result(fit):
    result, files = fit
    assert json.loads(files["result.json"]) == result
