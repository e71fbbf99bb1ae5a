"""What the API knows of the detector agrees with what the fitter finds."""

from pathlib import Path

import pytest

from fitter.detection import weights
from service.compute.models import check_detector
from service.compute.pipeline import fit_task
from service.compute.tasks import OPTIONS, ChildSetup, UnusableInputError
from service.demo_data.sample import load_sample
from service.jobs.inputs import SentPicture, named_pictures
from service.settings import SettingError, Settings
from service.submissions.submission import detector_is_installed

DETECTOR_FILES = tuple(each.name for each in weights.FILES)


def test_a_folder_counts_once_it_has_the_files(tmp_path: Path):
    for name in DETECTOR_FILES:
        assert not detector_is_installed(tmp_path)
        (tmp_path / name).touch()
    assert detector_is_installed(tmp_path)


def test_a_worker_without_it_ends_a_fit_that_wants_points_proposed(tmp_path: Path):
    asked = b'{"gender": "male", "views": [{"points": {}, "complete_points": true}]}'
    pictures = named_pictures([SentPicture(load_sample().image, None)])
    setup = ChildSetup(name="job", max_pixels=1_000_000, detector=tmp_path)
    with pytest.raises(UnusableInputError) as caught:
        fit_task(setup, {OPTIONS: asked, **pictures}, lambda _: None)
    told = caught.value.error
    assert (told.field, told.code) == ("views.0.points", "detector-not-installed")
    assert "pip install" in told.remedy


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
