"""Where the weights are looked for, and what is said where there are none."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from fitter.detection.weights import (
    BODY_LANDMARKS,
    FILES,
    PERSON_DETECTOR,
    checked_weights,
    detector_fault,
)
from fitter.errors import DetectorUnavailableError


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
