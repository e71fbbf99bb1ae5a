"""Where compiled kernels and prepared models are kept."""

import os
import sys

import pytest

from service.process import caches as settled
from service.process.caches import KERNELS, VARIABLE, settle_folders, users_folder


@pytest.fixture
def caches(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv(VARIABLE, raising=False)
    # Put back at the end, whatever is set meanwhile.
    monkeypatch.setenv(KERNELS, os.environ.get(KERNELS, ""))
    monkeypatch.setattr(settled, "make_work_folder", lambda: tmp_path / "work")
    return tmp_path


def test_models_are_kept_in_the_users_cache_and_nobody_else_reads_them(caches, monkeypatch):
    monkeypatch.setenv(VARIABLE, "")
    monkeypatch.delenv(VARIABLE)
    settle_folders()
    assert os.environ[VARIABLE] == str(caches / "maquette")
    assert (caches / "maquette").stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize("named", ["", "/elsewhere"])
def test_a_folder_that_the_environment_names_stays(caches, monkeypatch, named):
    monkeypatch.setenv(VARIABLE, named)
    settle_folders()
    assert os.environ[VARIABLE] == named
    assert list(caches.iterdir()) == []


@pytest.mark.parametrize("writable", [True, False])
def test_numba_keeps_kernels_beside_the_code_or_else_in_the_users_cache(
    caches, monkeypatch, writable
):
    monkeypatch.setenv(KERNELS, "")
    monkeypatch.setenv(VARIABLE, str(caches / "ours"))
    monkeypatch.setattr(os, "access", lambda *_: writable)
    # As in a process that has not loaded it yet.
    monkeypatch.delitem(sys.modules, "numba", raising=False)
    assert settle_folders() == caches / "work"
    assert os.environ[KERNELS] == ("" if writable else str(caches / "ours" / "kernels"))


def test_nothing_is_read_where_others_may_have_put_it(caches):
    (caches / "maquette").mkdir()
    (caches / "maquette").chmod(0o777)
    assert users_folder() is None


def test_without_a_home_there_is_no_folder(caches, monkeypatch):
    (caches / "home").touch()
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", str(caches / "home"))
    assert users_folder() is None


def test_a_cache_is_never_looked_for_in_the_current_folder(caches, monkeypatch):
    monkeypatch.chdir(caches)
    monkeypatch.setenv("XDG_CACHE_HOME", "here")
    assert users_folder() is None
    assert list(caches.iterdir()) == []


def test_a_folder_of_kernels_is_always_named_so_that_no_file_in_the_current_folder_does(
    caches, monkeypatch
):
    monkeypatch.delenv(KERNELS)
    settle_folders()
    assert os.environ[KERNELS] == ""


def test_where_numba_is_loaded_already_its_folder_stays(caches, monkeypatch):
    monkeypatch.setenv(KERNELS, "")
    monkeypatch.setitem(sys.modules, "numba", sys)
    settle_folders()
    assert os.environ[KERNELS] == ""
