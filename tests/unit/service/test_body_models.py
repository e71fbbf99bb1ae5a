"""The process that reads the body models, asked of good, damaged and lacking ones."""

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from fitter.body.storage import packaged_model_path
from service.compute.model_reader import describe
from service.compute.models_reading import COMMAND, READINGS, ModelsBeingRead
from service.settings import SettingError, Settings
from tests.changed_models import packaged, save, without

MODELS = packaged_model_path("female").parent


def copied(folder: Path) -> Path:
    return Path(shutil.copytree(MODELS, folder / "models"))


def refused(folder: Path) -> str:
    with pytest.raises(SettingError) as caught:
        ModelsBeingRead(Settings(models_dir=folder)).wait()
    message = str(caught.value)
    assert message.startswith(f"MAQUETTE_MODELS_DIR={folder}: ")
    assert "\n" not in message
    return message


def dying(note: Path, *, times: int) -> Sequence[str]:
    """A command that kills itself so many times, and then is the real one."""
    script = (
        "import os, sys\n"
        f"with open({str(note)!r}, 'a+') as note:\n"
        "    note.write('.')\n"
        f"if os.path.getsize({str(note)!r}) <= {times}: os.kill(os.getpid(), 9)\n"
        f"os.execv({COMMAND[0]!r}, {COMMAND!r})\n"
    )
    return (sys.executable, "-c", script)


def test_the_packaged_models_are_those_that_this_process_would_describe():
    assert ModelsBeingRead(Settings()).wait() == describe(None)


def test_models_of_one_s_own_are_described_from_their_folder(tmp_path: Path):
    assert ModelsBeingRead(Settings(models_dir=copied(tmp_path))).wait() == describe(None)


def test_a_damaged_model_is_told_by_name(tmp_path: Path):
    damaged = copied(tmp_path) / "male.npz"
    damaged.write_bytes(damaged.read_bytes()[:-100_000])
    assert "male.npz" in refused(damaged.parent)


def test_a_landmark_that_a_fit_needs_is_missed(tmp_path: Path):
    lacking = without(packaged().landmarks, "navel")
    models = copied(tmp_path)
    save(models / "female.npz", replace(packaged(), landmarks=lacking))
    assert "lacks what a fit needs: navel" in refused(models)


def test_a_process_that_dies_is_started_again(tmp_path: Path, caplog: pytest.LogCaptureFixture):
    note = tmp_path / "note"
    models = ModelsBeingRead(Settings(), command=dying(note, times=READINGS - 1))
    assert models.wait() == describe(None)
    assert note.read_text() == "." * READINGS
    assert caplog.text.count("Reading the body models died, exit code -9") == READINGS - 1


def test_a_process_that_always_dies_is_given_up(tmp_path: Path):
    note = tmp_path / "note"
    with pytest.raises(RuntimeError, match="cannot be read"):
        ModelsBeingRead(Settings(), command=dying(note, times=1_000)).wait()
    assert note.read_text() == "." * READINGS


def test_a_process_that_nobody_listens_to_ends_without_a_word():
    ours, theirs = os.pipe()
    with subprocess.Popen(COMMAND, stdout=theirs, stderr=subprocess.PIPE, text=True) as process:
        os.close(theirs)
        os.close(ours)
        assert process.communicate()[1] == ""
        assert process.returncode == 0
