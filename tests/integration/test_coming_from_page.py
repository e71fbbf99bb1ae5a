"""The page for those who come from elsewhere: its code runs, its requests are understood."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from api_schemas.points import OPENPOSE_BODY25_INDEX, PointsFormat, named_points
from api_schemas.requests import FitRequest
from api_schemas.scans import ScanRequest
from fitter.body.scape import CAMERA_AXES, ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters
from fitter.training.articulation.part_tree import PART_NAMES
from fitter.training.own_bodies.folder import read_own_bodies
from fitter.training.own_bodies.template import packaged_template
from fitter.vocabulary.measurements import MEASUREMENT_UNITS
from tests.readme import block

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "service" / "docs" / "coming_from.md").read_text()
RESULT = {"measurements": [{"name": name, "value": 71.25} for name in MEASUREMENT_UNITS]}


def run(name: str) -> dict[str, Any]:
    """What a block of the page defines."""
    defined: dict[str, Any] = {}
    exec(block(name, PAGE), defined)
    return defined


def understood(request: dict[str, Any]) -> ScanRequest:
    """The request as the service reads it."""
    return ScanRequest.model_validate_json(json.dumps(request))


def test_every_python_block_is_tested():
    assert len(re.findall(r"^```python", PAGE, re.MULTILINE)) == len(
        re.findall(r"<!-- tested: ", PAGE)
    )


def test_a_request_as_bodygram_has_it_becomes_a_scan():
    stats = {"age": 29, "gender": "female", "height": 1640, "weight": 54000}
    asked = understood(run("bodygram")["scan_request"](stats))
    assert asked.height_m == pytest.approx(1.64)
    assert asked.weight_kg == pytest.approx(54.0)
    assert [view.view.value for view in asked.views] == ["front", "side"]


def test_measurements_come_back_under_bodygrams_names():
    page = run("bodygram")
    assert set(page["NAMES"].values()) <= set(MEASUREMENT_UNITS)
    assert len(set(page["NAMES"].values())) == len(page["NAMES"])
    found = {each["name"]: each for each in page["as_before"](RESULT)}
    assert found["hipGirth"] == {"name": "hipGirth", "unit": "mm", "value": 712}


@pytest.mark.parametrize("weight", [None, 80.0])
def test_a_person_as_3dlook_has_them_becomes_a_scan(weight: float | None):
    person = {"gender": "male", "height": 180, "weight": weight}
    asked = understood(run("3dlook")["scan_request"](person))
    assert asked.height_m == pytest.approx(1.8)
    assert asked.weight_kg == weight


def test_measurements_come_back_in_3dlooks_groups():
    page = run("3dlook")
    ours = [name for names in page["NAMES"].values() for name in names.values()]
    assert set(ours) <= set(MEASUREMENT_UNITS)
    assert len(set(ours)) == len(ours)
    assert page["as_before"](RESULT)["volume_params"]["low_hips"] == pytest.approx(71.2, abs=0.06)


def test_openpose_output_becomes_a_fit_that_holds_little_to_what_it_hardly_saw(tmp_path: Path):
    rows = [[10.0 * at, 5.0 * at, 0.9] for at in range(25)]
    rows[OPENPOSE_BODY25_INDEX["left_wrist"]][2] = 0.05
    rows[OPENPOSE_BODY25_INDEX["right_wrist"]][2] = 0.0
    people = [{"pose_keypoints_2d": [number for row in rows for number in row]}]
    file = tmp_path / "picture_keypoints.json"
    file.write_text(json.dumps({"version": 1.3, "people": people}))
    request = run("openpose")["fit_request"](file, gender="female", height_m=1.68)
    asked = FitRequest.model_validate_json(json.dumps(request))
    assert asked.format is PointsFormat.OPENPOSE_BODY25
    assert asked.points != "auto"
    points = named_points(asked.points, asked.format, width=640, height=480)
    assert set(OPENPOSE_BODY25_INDEX) - set(points) == {"right_wrist"}
    assert (points["left_wrist"].confidence, points["left_shoulder"].confidence) == (0.05, 0.9)
    assert (points["left_shoulder"].x, points["left_shoulder"].y) == (50.0, 25.0)


def test_a_root_is_turned_into_the_frame_here():
    """A body under the page's root stands as SMPL's would under its own in the camera's frame."""
    model = load_body_model(packaged_model_path("female"))
    evaluator = ScapeEvaluator(model)
    still = BodyParameters(
        pose=np.zeros((len(model.part_names), 3)),
        translation=np.zeros(3),
        shape=np.zeros(len(model.shape_basis)),
    )
    own_axes = evaluator.vertices(still) * CAMERA_AXES
    orient = np.array([2.9, 0.3, -0.4])
    pose = still.pose.copy()
    pose[0] = run("frames")["root_pose"](orient)
    place = np.array([0.1, -0.2, 3.0])
    found = evaluator.vertices(BodyParameters(pose=pose, translation=place, shape=still.shape))
    expected = own_axes @ Rotation.from_rotvec(orient).as_matrix().T + place
    assert np.abs(found - expected).max() < 1e-6


def test_parts_share_out_all_of_smpls_joints():
    page = run("frames")
    assert tuple(page["PARTS"]) == tuple(PART_NAMES)
    assert sorted(joint for joints in page["PARTS"].values() for joint in joints) == list(range(24))
    weights = np.random.default_rng(0).dirichlet(np.ones(24), size=5)
    shares = page["skinning_of_parts"](weights)
    assert shares.shape == (5, 17)
    assert shares.sum(axis=1) == pytest.approx(1.0)


def test_bodies_that_the_page_writes_can_be_learned_from(tmp_path: Path):
    model = load_body_model(packaged_model_path("female"))
    rng = np.random.default_rng(1)
    bodies = {
        name: rest_vertices(model, rng.normal(size=len(model.shape_basis))) for name in "abcde"
    }
    run("own bodies")["write_bodies"](
        tmp_path / "bodies", bodies, source="drawn for a test", licence="CC0-1.0"
    )
    found = read_own_bodies(tmp_path / "bodies", packaged_template(model))
    assert found.subjects == tuple("abcde")
    assert np.abs(found.rest[2] - bodies["c"]).max() < 1e-9


def test_figures_of_the_page_are_those_of_the_code():
    model = load_body_model(packaged_model_path("female"))
    text = " ".join(PAGE.split())
    assert f"{len(model.mean_vertices):,} vertices" in text
    assert f"| {len(MEASUREMENT_UNITS)}, with standard errors |" in text
    assert f"the vertices of {len(model.landmarks.names)} landmarks" in text
