import json
import zipfile
from pathlib import Path

import numpy as np
import pytest

from fitter.body.model import BodyModel
from fitter.body.storage import (
    FIELDS,
    HEADER_KEYS,
    arrays_checksum,
    load_body_model,
    save_body_model,
)
from fitter.errors import ModelFileError
from fitter.training.assemble import model_arrays
from tests.unit.body.synthetic_model import bar_model

MODEL = bar_model()
HEADER = {
    "gender": "female",
    "units": "metres",
    "part_names": list(MODEL.part_names),
    "landmark_names": list(MODEL.landmarks.names),
    "sources": ["a bar"],
    "licences": ["CC0-1.0"],
    "seed": 0,
}


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / "female.npz"
    save_body_model(path, header=HEADER, arrays=model_arrays(MODEL))
    return path


def rewrite(path: Path, changes, *, keep_checksum: bool = False):
    """Store the file again with some members changed, as a careless tool would."""
    with np.load(path) as archive:
        members = {name: archive[name] for name in archive.files}
    header = json.loads(members.pop("header").tobytes())
    changes(header, members)
    if not keep_checksum and set(FIELDS) <= set(members):
        header["checksum"] = arrays_checksum(members)
    encoded = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(path, header=encoded, **members)


def assert_refused(path: Path, *words: str):
    with pytest.raises(ModelFileError) as caught:
        load_body_model(path)
    for word in (path.name, *words):
        assert word in str(caught.value)


def test_what_is_saved_comes_back(saved):
    loaded = load_body_model(saved)
    assert isinstance(loaded, BodyModel)
    assert (loaded.gender, loaded.part_names) == ("female", MODEL.part_names)
    before, after = model_arrays(MODEL), model_arrays(loaded)
    for name in FIELDS:
        np.testing.assert_array_equal(after[name], before[name], err_msg=name)
    assert loaded.landmarks.names == MODEL.landmarks.names
    assert loaded.header["sources"] == ["a bar"]


def test_the_same_model_gives_the_same_bytes(saved, tmp_path):
    again = tmp_path / "again.npz"
    save_body_model(again, header=HEADER, arrays=model_arrays(MODEL))
    assert again.read_bytes() == saved.read_bytes()


def test_a_missing_file_says_how_to_build_one(tmp_path):
    assert_refused(tmp_path / "none.npz", "python -m fitter.training")


@pytest.mark.parametrize("content", [b"", b"not an archive", b"PK\x03\x04 half an archive"])
def test_a_file_of_another_kind_is_refused(tmp_path, content):
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    assert_refused(path, "not a readable body model")


@pytest.mark.parametrize("share", [0.2, 0.6, 0.99])
def test_a_truncated_file_is_refused(saved, share):
    content = saved.read_bytes()
    saved.write_bytes(content[: int(share * len(content))])
    assert_refused(saved, "not a readable body model")


def test_pickled_objects_are_not_opened(saved):
    rewrite(
        saved,
        lambda _, members: members.update(uv=np.array([{}], dtype=object)),
        keep_checksum=True,
    )
    assert_refused(saved, "not a readable body model")


def test_a_flipped_number_breaks_the_checksum(saved):
    def flip(_, members):
        members["mean_vertices"][3, 1] += 1e-3

    rewrite(saved, flip, keep_checksum=True)
    assert_refused(saved, "checksum")


def test_another_format_version_is_named(saved):
    rewrite(saved, lambda header, _: header.update(format_version=99))
    assert_refused(saved, "format_version", "99")


@pytest.mark.parametrize("key", HEADER_KEYS)
def test_a_missing_header_entry_is_named(saved, key):
    rewrite(saved, lambda header, _: header.pop(key), keep_checksum=True)
    assert_refused(saved, f"header.{key}")


def test_a_missing_header_is_refused(saved):
    with np.load(saved) as archive:
        members = {name: archive[name] for name in archive.files if name != "header"}
    np.savez(saved, **members)
    assert_refused(saved)


@pytest.mark.parametrize("name", FIELDS)
def test_a_missing_field_is_named(saved, name):
    rewrite(saved, lambda _, members: members.pop(name), keep_checksum=True)
    assert_refused(saved, name, "missing")


@pytest.mark.parametrize("name", FIELDS)
def test_a_field_of_another_rank_is_named(saved, name):
    rewrite(saved, lambda _, members: members.update({name: members[name][None]}))
    assert_refused(saved, name, "shape")


@pytest.mark.parametrize("name", FIELDS)
def test_a_field_of_another_type_is_named(saved, name):
    other = "i4" if FIELDS[name][0] == "f" else "f4"
    rewrite(saved, lambda _, members: members.update({name: members[name].astype(other)}))
    assert_refused(saved, name, "type")


@pytest.mark.parametrize("name", [name for name, (kind, _) in FIELDS.items() if kind == "f"])
def test_a_number_that_is_not_finite_is_named(saved, name):
    def spoil(_, members):
        members[name].reshape(-1)[0] = np.nan

    rewrite(saved, spoil)
    assert_refused(saved, name, "finite")


@pytest.mark.parametrize(
    "name",
    [
        "triangles",
        "part_of_triangle",
        "part_parent",
        "joint_indices",
        "skinning_parts",
        "pose_feature_joints",
        "incidence_vertices",
        "landmark_indices",
        "uv_triangles",
        "mirror",
    ],
)
@pytest.mark.parametrize("value", [-5, 10**6])
def test_an_index_out_of_range_is_named(saved, name, value):
    def spoil(_, members):
        members[name].reshape(-1)[0] = value

    rewrite(saved, spoil)
    assert_refused(saved, name, "index")


@pytest.mark.parametrize("name", ["mean_vertices", "skinning_weights", "mirror", "shape_basis"])
def test_fields_that_disagree_on_the_number_of_vertices_are_named(saved, name):
    def shorten(_, members):
        axis = 1 if name == "shape_basis" else 0
        members[name] = np.delete(members[name], -1, axis=axis)

    rewrite(saved, shorten)
    assert_refused(saved, "shape")


def test_a_wrong_field_is_refused_before_it_is_written(tmp_path):
    arrays = model_arrays(MODEL)
    arrays["uv"] = arrays["uv"].astype(np.int32)
    with pytest.raises(ModelFileError, match="uv"):
        save_body_model(tmp_path / "bad.npz", header=HEADER, arrays=arrays)
    assert not (tmp_path / "bad.npz").exists()


def test_a_member_damaged_inside_the_archive_is_refused(saved):
    with zipfile.ZipFile(saved) as archive:
        entry = archive.getinfo("mean_vertices.npy")
        offset = entry.header_offset + 60 + entry.compress_size // 2
    content = bytearray(saved.read_bytes())
    content[offset] ^= 0xFF
    saved.write_bytes(bytes(content))
    assert_refused(saved)


def test_a_bare_array_is_refused(tmp_path):
    path = tmp_path / "female.npz"
    with path.open("wb") as stream:
        np.save(stream, np.zeros(3))
    assert_refused(path, "not a readable body model")
