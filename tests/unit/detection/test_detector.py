"""The detector, and the files of its networks."""

import importlib.util
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.detection.detector import (
    Detector,
    body_of_clicks,
    installed_detector,
    is_somebody_at,
)
from fitter.detection.person_detector import PersonDetector
from fitter.detection.weights import (
    BODY_LANDMARKS,
    FILES,
    PERSON_DETECTOR,
    checked_weights,
    detector_fault,
)
from fitter.errors import DetectorUnavailableError
from fitter.request import Click
from tests.accuracy.files import PICTURES_FOLDER

STANDING, OTHER = "man_young_thin_standing", "man_old_heavy_standing"

LIMB_POINTS = [
    f"{side}_{joint}"
    for side in ("left", "right")
    for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
]


@pytest.fixture(scope="module")
def detector() -> Detector:
    return installed_detector()


def picture(name: str) -> np.ndarray:
    return np.asarray(PillowImage.open(PICTURES_FOLDER / f"{name}.jpg").convert("RGB"))


def clicks(name: str, *, shift: float = 0.0) -> dict[str, Click]:
    points = json.loads((PICTURES_FOLDER / f"{name}.json").read_text())["request"]["points"]
    return {name: Click(x=each["x"] + shift, y=each["y"]) for name, each in points.items()}


def test_proposals_lie_near_where_the_points_truly_are(detector):
    (body,) = detector.bodies(picture(STANDING))
    truth = clicks(STANDING)
    off = [
        np.hypot(body.points[name].x - truth[name].x, body.points[name].y - truth[name].y)
        for name in LIMB_POINTS
    ]
    # The person is about 500 pixels high, and the clicks are a hand's.
    assert np.median(off) < 0.025 * 500
    assert max(off) < 0.06 * 500
    assert all(body.points[name].spread_m > 0.0 for name in LIMB_POINTS)
    assert body.slants.limbs.keys() == {
        f"{side}_{limb}" for side in ("left", "right") for limb in ("upper_arm", "thigh", "shin")
    }


def test_the_mask_covers_the_person(detector):
    (body,) = detector.bodies(picture(STANDING))
    true = (
        np.asarray(PillowImage.open(PICTURES_FOLDER / f"{STANDING}_person.png").convert("L")) > 127
    )
    found = body.mask > 0.5
    assert (found & true).sum() > 0.93 * (found | true).sum()


def test_nobody_is_found_on_a_wall(detector):
    noise = np.random.default_rng(3).integers(90, 110, (480, 640, 3), dtype=np.uint8)
    assert detector.bodies(noise) == ()


def test_who_was_clicked_is_chosen_among_several(detector):
    left, right = picture(STANDING), picture(OTHER)
    both = np.concatenate([left, right[: left.shape[0]]], axis=1)
    bodies = detector.bodies(both)
    assert len(bodies) == 2
    clicked_left = body_of_clicks(bodies, clicks(STANDING))
    clicked_right = body_of_clicks(bodies, clicks(OTHER, shift=left.shape[1]))
    assert clicked_left is not None
    assert clicked_right is not None
    assert clicked_left.points["nose"].x < left.shape[1] < clicked_right.points["nose"].x
    assert body_of_clicks(bodies, {}) is bodies[0]


def test_clicks_on_somebody_who_was_not_found_are_nobodys(detector):
    bodies = detector.bodies(picture(STANDING))
    assert body_of_clicks(bodies, clicks(STANDING, shift=300.0)) is None


def test_somebody_is_where_the_points_are_even_if_they_are_roughly_there(detector):
    bodies = detector.bodies(picture(STANDING))
    said = [
        is_somebody_at(bodies, clicks(STANDING, shift=shift * bodies[0].person.radius))
        for shift in (0.0, 0.2, 0.5)
    ]
    assert said == [True, True, False]
    assert (is_somebody_at(bodies, {}), is_somebody_at((), {})) == (True, False)
    assert body_of_clicks((), clicks(STANDING)) is None


def test_what_lies_beyond_the_picture_is_not_proposed(detector):
    cropped = picture(STANDING)[:380]
    (body,) = detector.bodies(cropped)
    assert "left_ankle" not in body.points
    assert "left_shin" not in body.slants.limbs
    assert "left_shoulder" in body.points


def test_who_is_wrongly_taken_to_stand_on_their_hands_is_turned(detector, monkeypatch):
    (right,) = detector.bodies(picture(STANDING))
    wrong = replace(right.person, rim=2.0 * right.person.middle - right.person.rim)
    assert wrong.is_head_down
    monkeypatch.setattr(PersonDetector, "persons", lambda *_: (wrong,))
    (body,) = detector.bodies(picture(STANDING))
    for name in LIMB_POINTS:
        assert body.points[name].y == pytest.approx(right.points[name].y, abs=15.0)


def test_who_stands_on_their_hands_is_left_so(detector):
    turned = np.ascontiguousarray(picture(STANDING)[::-1, ::-1])
    height, width = turned.shape[:2]
    (body,) = detector.bodies(turned)
    truth = clicks(STANDING)
    assert body.person.is_head_down
    for name in ("left_wrist", "right_ankle", "nose"):
        assert body.points[name].x == pytest.approx(width - truth[name].x, abs=25.0)
        assert body.points[name].y == pytest.approx(height - truth[name].y, abs=25.0)


def test_the_installed_package_has_the_files():
    assert detector_fault() is None
    weights = checked_weights()
    assert weights.person_detector.name == PERSON_DETECTOR.name
    assert weights.body_landmarks.name == BODY_LANDMARKS.name


def files_in(folder: Path) -> list[Path]:
    weights = checked_weights()
    kept = weights.person_detector, weights.body_landmarks, weights.face_detector
    for each in kept:
        (folder / each.name).write_bytes(each.read_bytes())
    return [folder / each.name for each in kept]


def test_a_folder_may_hold_them(tmp_path):
    kept = files_in(tmp_path)
    found = checked_weights(tmp_path)
    assert [found.person_detector, found.body_landmarks, found.face_detector] == kept


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(DetectorUnavailableError, match=PERSON_DETECTOR.name) as raised:
        checked_weights(tmp_path)
    assert "pip install" in raised.value.remedy


def test_another_file_of_the_same_name_is_refused(tmp_path):
    _, landmarks, _ = files_in(tmp_path)
    landmarks.write_bytes(landmarks.read_bytes()[:-1] + b"x")
    with pytest.raises(DetectorUnavailableError, match=BODY_LANDMARKS.name):
        checked_weights(tmp_path)


@pytest.mark.parametrize(
    ("gone", "told"), [("ai_edge_litert", "ai-edge-litert"), ("mediapipe", "mediapipe")]
)
def test_without_runtime_or_weights_there_is_no_detector(monkeypatch, tmp_path, gone, told):
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == gone else found(name)
    )
    # Files that happen to lie in the current folder are nobody's weights.
    for each in FILES:
        (tmp_path / each.name).touch()
    monkeypatch.chdir(tmp_path)
    assert detector_fault() is not None
    with pytest.raises(DetectorUnavailableError, match=told):
        checked_weights()


def test_loading_the_networks_writes_nothing_into_its_caller_s_log():
    code = (
        "import sys\n"
        "from fitter.detection.detector import installed_detector\n"
        "installed_detector()\n"
        "print('afterwards', file=sys.stderr)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=600
    )
    assert (done.stdout, done.stderr) == ("", "afterwards\n")
