"""Body models and detector as they are found at start: good, damaged, lacking."""

import shutil
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from fitter.body.storage import packaged_model_path
from fitter.detection import weights
from service.compute import models
from service.compute.models import check_detector, check_models, describe, read_models
from service.settings import SettingError, Settings
from service.submissions.submission import detector_is_installed
from tests.changed_models import packaged, save, without

MODELS = packaged_model_path("female").parent


def copied(folder: Path) -> Path:
    return Path(shutil.copytree(MODELS, folder / "models"))


def refused(folder: Path) -> str:
    with pytest.raises(SettingError) as caught:
        check_models(Settings(models_dir=folder))
    message = str(caught.value)
    assert message.startswith(f"MAQUETTE_MODELS_DIR={folder}: ")
    assert "\n" not in message
    return message


def test_models_are_those_that_this_process_would_describe(tmp_path: Path):
    described = describe(None)
    assert read_models(Settings()) == described
    assert read_models(Settings(models_dir=copied(tmp_path))) == described


def test_a_damaged_model_is_told_by_name(tmp_path: Path):
    damaged = copied(tmp_path) / "male.npz"
    damaged.write_bytes(damaged.read_bytes()[:-100_000])
    assert "male.npz" in refused(damaged.parent)


def test_a_model_of_the_other_gender_is_told_by_name(tmp_path: Path):
    folder = copied(tmp_path)
    shutil.copy(folder / "female.npz", folder / "male.npz")
    assert "male.npz" in refused(folder)


def test_a_landmark_that_a_fit_needs_is_missed(tmp_path: Path):
    lacking = without(packaged().landmarks, "navel")
    folder = copied(tmp_path)
    save(folder / "female.npz", replace(packaged(), landmarks=lacking))
    assert "lacks what a fit needs: navel" in refused(folder)


def test_a_process_that_dies_is_no_fault_of_the_models(monkeypatch: pytest.MonkeyPatch):
    dying = (sys.executable, "-c", "import os; os.kill(os.getpid(), 9)")
    monkeypatch.setattr(models, "COMMAND", dying)
    with pytest.raises(RuntimeError, match="exit code -9"):
        read_models(Settings())


DETECTOR_FILES = tuple(each.name for each in weights.FILES)


def test_a_folder_counts_once_it_has_the_files(tmp_path: Path):
    for name in DETECTOR_FILES:
        assert not detector_is_installed(tmp_path)
        (tmp_path / name).touch()
    assert detector_is_installed(tmp_path)


def test_files_that_are_others_are_an_unusable_setting(tmp_path: Path):
    given = weights.checked_weights()
    for each in (given.person_detector, given.body_landmarks, given.face_detector):
        (tmp_path / each.name).write_bytes(each.read_bytes())
    check_detector(Settings(detector_dir=tmp_path))
    (tmp_path / DETECTOR_FILES[1]).write_bytes(b"something else")
    with pytest.raises(SettingError) as caught:
        check_detector(Settings(detector_dir=tmp_path))
    message = str(caught.value)
    assert message.startswith(f"MAQUETTE_DETECTOR_DIR={tmp_path}: {DETECTOR_FILES[1]}")
    assert "\n" not in message
    check_detector(Settings())
