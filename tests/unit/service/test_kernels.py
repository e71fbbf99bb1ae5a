"""The folder that compiled kernels are kept in."""

import os
import stat

import pytest

from service.process.kernels import VARIABLE, keep_kernels, own_folder


def test_a_folder_that_the_environment_names_stays(monkeypatch, tmp_path):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    keep_kernels()
    assert os.environ[VARIABLE] == str(tmp_path)


@pytest.mark.parametrize("unset", [None, ""])
def test_where_numba_can_write_the_choice_is_its_own(monkeypatch, unset):
    monkeypatch.setenv(VARIABLE, "")
    if unset is None:
        monkeypatch.delenv(VARIABLE)
    keep_kernels()
    assert os.environ[VARIABLE] == ""


def test_a_users_own_folder_is_private_and_the_same_every_time(tmp_path):
    folder = own_folder(tmp_path)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert own_folder(tmp_path) == folder


def made_by_somebody_else(folder):
    folder.mkdir()
    folder.chmod(0o777)


def linked_elsewhere(folder):
    folder.symlink_to(folder.parent / "nowhere")


def a_file(folder):
    folder.touch()


@pytest.mark.parametrize("made", [made_by_somebody_else, linked_elsewhere, a_file])
def test_compiled_code_is_never_read_where_others_may_have_put_it(tmp_path, made):
    made(tmp_path / f"maquette-kernels-{os.geteuid()}")
    folder = own_folder(tmp_path)
    assert folder != tmp_path / f"maquette-kernels-{os.geteuid()}"
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
