"""Prepared models that are kept in files."""

import logging
import os
import stat
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from fitter.fits import kept_models
from fitter.fits.kept_models import KEPT, VARIABLE, kept


@dataclass
class Prepared:
    values: np.ndarray
    same: np.ndarray
    names: tuple[str, ...]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(VARIABLE, str(tmp_path / "cache" / "kept"))
    return tmp_path / "cache" / "kept"


@pytest.fixture
def source(tmp_path: Path) -> Path:
    path = tmp_path / "model.npz"
    path.write_bytes(b"a model")
    return path


def made() -> Prepared:
    values = np.random.default_rng(1).normal(size=(7, 3))
    return Prepared(values=values, same=values, names=("a", "b"))


def not_made() -> Prepared:
    raise AssertionError


def test_what_was_made_once_is_read(folder: Path, source: Path):
    first = kept(source, made)
    second = kept(source, not_made)
    assert second.values.tobytes() == first.values.tobytes()
    assert second.same is second.values
    assert second.names == first.names
    (path,) = folder.iterdir()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_arrays_are_laid_out_as_they_were_and_writing_to_them_changes_no_file(folder, source):
    columns = np.asfortranarray(np.arange(12.0).reshape(3, 4))
    kept(source, lambda: columns)
    read = kept(source, not_made)
    assert read.flags.f_contiguous
    assert read.flags.aligned
    read[:] = -1.0
    np.testing.assert_array_equal(kept(source, not_made), columns)


@pytest.mark.parametrize("changed", ["model", "name", "code"])
def test_another_model_name_or_code_is_prepared_anew(folder, source, monkeypatch, changed):
    kept(source, lambda: "before")
    if changed == "model":
        source.write_bytes(b"another model")
    elif changed == "name":
        source = source.rename(source.with_name("other.npz"))
    else:
        monkeypatch.setattr(kept_models, "code_digest", lambda: b"other code")
    assert kept(source, lambda: "after") == "after"


def cut_short(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-100])


def emptied(path: Path) -> None:
    path.write_bytes(b"")


def overwritten(path: Path) -> None:
    path.write_bytes(bytes(range(256)) * 8)


def zeroed(path: Path) -> None:
    path.write_bytes(bytes(path.stat().st_size))


def flipped(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[-80] ^= 1
    path.write_bytes(content)


def replaced_by_a_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


@pytest.mark.parametrize("damage", [cut_short, emptied, overwritten, zeroed, flipped])
def test_a_damaged_file_is_told_of_and_made_anew(folder, source, caplog, damage):
    kept(source, made)
    (path,) = folder.iterdir()
    damage(path)
    with caplog.at_level(logging.WARNING):
        assert kept(source, made).names == ("a", "b")
    assert [record.levelname for record in caplog.records] == ["WARNING"]
    assert "is made anew" in caplog.text
    assert kept(source, not_made).names == ("a", "b")


@pytest.mark.parametrize("bit", range(0, 8 * 300, 101))
def test_every_flipped_bit_is_found(folder, source, bit):
    kept(source, made)
    (path,) = folder.iterdir()
    content = bytearray(path.read_bytes())
    content[64 + bit // 8] ^= 1 << bit % 8
    path.write_bytes(content)
    np.testing.assert_array_equal(kept(source, made).values, made().values)
    assert path.read_bytes() != bytes(content)


def test_what_cannot_be_read_is_made_and_told(folder, source, caplog):
    kept(source, made)
    (path,) = folder.iterdir()
    replaced_by_a_folder(path)
    with caplog.at_level(logging.WARNING):
        assert kept(source, made).names == ("a", "b")
    assert "is made anew" in caplog.text


def test_what_a_process_left_unfinished_is_removed_by_the_next_that_writes(folder, source):
    folder.mkdir(parents=True)
    left, being_written = folder / "left.new", folder / "being_written.new"
    for file in (left, being_written):
        file.touch()
    os.utime(left, (0.0, 0.0))
    kept(source, made)
    assert not left.exists()
    assert being_written.exists()


def test_without_a_folder_nothing_is_kept(tmp_path, source, monkeypatch):
    monkeypatch.setenv(VARIABLE, "")
    kept(source, made)
    with pytest.raises(AssertionError):
        kept(source, not_made)
    assert list(tmp_path.iterdir()) == [source]


def test_where_nothing_can_be_kept_it_is_made_and_that_is_told(folder, source, caplog):
    folder.parent.write_bytes(b"no folder")
    with caplog.at_level(logging.WARNING):
        assert kept(source, made).names == ("a", "b")
    assert "could not be kept" in caplog.text


def test_the_oldest_files_are_erased(folder, source):
    for number in range(KEPT + 2):
        source.write_bytes(bytes([number]))
        kept(source, lambda: "something")
    assert len(list(folder.iterdir())) == KEPT
    assert kept(source, not_made) == "something"


def test_what_is_wrong_with_a_model_is_raised(folder, tmp_path):
    with pytest.raises(AssertionError):
        kept(tmp_path / "missing.npz", not_made)
