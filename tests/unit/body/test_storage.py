import json
import warnings
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fitter.body.model import BodyModel
from fitter.body.model_checks import FIELDS, HEADER_KEYS, INDEX_BOUNDS
from fitter.body.storage import arrays_checksum, load_body_model, save_body_model
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


def assert_refused(path: Path, *words: str, gender: str | None = None):
    """The one error there is names the file, says these words and what to do."""
    with pytest.raises(ModelFileError) as caught:
        load_body_model(path, gender=gender)
    for word in (path.name, *words):
        assert word in str(caught.value)
    assert caught.value.remedy.endswith(".")


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


@pytest.mark.parametrize("name", FIELDS)
def test_a_missing_field_is_named(saved, name):
    rewrite(saved, lambda _, members: members.pop(name), keep_checksum=True)
    assert_refused(saved, name, "missing")


@pytest.mark.parametrize("name", FIELDS)
def test_a_field_of_another_rank_is_named(saved, name):
    rewrite(saved, lambda _, members: members.update({name: members[name][None]}))
    assert_refused(saved, name, "shape")


def retype(name: str, other: str):
    return lambda _, members: members.update({name: members[name].astype(other)})


@pytest.mark.parametrize("name", FIELDS)
def test_a_field_of_another_type_is_named(saved, name):
    for other in ("i4" if FIELDS[name][0] == "f" else "f4", "U9", "c8", "?"):
        changed = saved.with_name(f"{np.dtype(other).kind}.npz")
        changed.write_bytes(saved.read_bytes())
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            rewrite(changed, retype(name, other))
        assert_refused(changed, name, "type", "expected")


@pytest.mark.parametrize("name", FIELDS)
def test_an_empty_field_is_named(saved, name):
    rewrite(saved, lambda _, members: members.update({name: members[name][:0]}))
    assert_refused(saved, name)


def test_a_field_nobody_knows_is_named(saved):
    rewrite(saved, lambda _, members: members.update(colour=np.zeros(3)))
    assert_refused(saved, "colour", "no field", "mirror")


@pytest.mark.parametrize("name", [name for name, (kind, _) in FIELDS.items() if kind == "f"])
def test_a_number_that_is_not_finite_is_named(saved, name):
    def spoil(_, members):
        members[name].reshape(-1)[0] = np.nan

    rewrite(saved, spoil)
    assert_refused(saved, name, "finite")


@pytest.mark.parametrize("name", INDEX_BOUNDS)
@pytest.mark.parametrize("value", [-5, 10**6])
def test_an_index_out_of_range_is_named(saved, name, value):
    def spoil(_, members):
        members[name].reshape(-1)[0] = value

    rewrite(saved, spoil)
    assert_refused(saved, name, "index", str(value), "expected [")


@pytest.mark.parametrize("name", ["mean_vertices", "skinning_weights", "mirror", "shape_basis"])
def test_fields_that_disagree_on_the_number_of_vertices_are_named(saved, name):
    def shorten(_, members):
        axis = 1 if name == "shape_basis" else 0
        members[name] = np.delete(members[name], -1, axis=axis)

    rewrite(saved, shorten)
    assert_refused(saved, "shape")


def put(name: str, place: int | tuple[int, ...], value: float):
    def spoil(_, members):
        members[name][place] = value

    return spoil


FAULTS = {
    "a gap in the pointers": (put("joint_pointers", 0, 1), "joint_pointers", "begin at 0"),
    "an empty row": (put("landmark_pointers", 1, 0), "landmark_pointers", "rise"),
    "pointers that end early": (put("landmark_pointers", -1, 2), "landmark_pointers", "end at 3"),
    "a falling pointer": (put("joint_pointers", 1, 17), "joint_pointers", "rise"),
    "incidences cut short": (put("incidence_pointers", -1, 3), "incidence_pointers", "end at"),
    "a vertex no longer there": (put("lighter_corners", (2, 1), 999), "lighter_corners", "999"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_rule_that_is_broken_is_named_with_what_was_found(saved, fault):
    spoil, *words = FAULTS[fault]
    rewrite(saved, spoil)
    assert_refused(saved, *words)


HEADER_FAULTS = {
    "another gender": ("gender", "child", "female or male"),
    "no gender": ("gender", None, "female or male"),
    "an empty name": ("part_names", ["bottom", "", "top"], "none empty"),
    "a name that is none": ("landmark_names", ["crown", 3, "sole_left"], "list of names"),
    "names in one text": ("part_names", "bottom middle top", "list of names"),
    "no sole": ("landmark_names", ["crown", "sole_left", "navel"], "sole_right"),
    "too few names": ("part_names", ["bottom", "top"], "p = 2"),
    "a version in words": ("format_version", "2", "reads 2"),
}


@pytest.mark.parametrize("fault", HEADER_FAULTS)
def test_a_wrong_header_entry_is_named(saved, fault):
    key, value, word = HEADER_FAULTS[fault]
    rewrite(saved, lambda header, _: header.update({key: value}))
    assert_refused(saved, word)


@pytest.mark.parametrize("header", [b"", b"no JSON", b"[]", b"3", b'"text"', b"[" * 100_000])
def test_a_header_of_another_form_is_refused(saved, header):
    with np.load(saved) as archive:
        members = {name: archive[name] for name in archive.files}
    members["header"] = np.frombuffer(header, dtype=np.uint8)
    np.savez(saved, **members)
    assert_refused(saved, "header")


def test_the_model_of_another_gender_is_refused_where_one_is_wanted(saved):
    assert load_body_model(saved, gender="female").gender == "female"
    assert_refused(saved, "header.gender", "expected male", "female.npz", gender="male")


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize("end", [0, -1])
def test_any_number_that_is_changed_is_noticed(saved, name, end):
    """By the rule it breaks, or by the checksum."""

    def change(_, members):
        flat = members[name].reshape(-1)
        flat[end] = flat[end] + 1

    rewrite(saved, change, keep_checksum=True)
    assert_refused(saved)


@given(place=st.floats(0.0, 1.0), bit=st.integers(0, 7))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
def test_a_flipped_bit_is_refused_or_changes_nothing(saved, place, bit):
    content = bytearray(saved.read_bytes())
    content[int(place * (len(content) - 1))] ^= 1 << bit
    flipped = saved.with_name("flipped.npz")
    flipped.write_bytes(bytes(content))
    try:
        loaded = load_body_model(flipped)
    except ModelFileError:
        return
    before, after = model_arrays(MODEL), model_arrays(loaded)
    for name in FIELDS:
        np.testing.assert_array_equal(after[name], before[name], err_msg=name)


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
