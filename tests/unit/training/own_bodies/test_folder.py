"""A folder as it should be, and each fault of one: what is said, and of which file."""

import json
from pathlib import Path

import numpy as np
import pytest

from fitter.errors import MeshFolderError
from fitter.numerics.rotations import rotation_matrices
from fitter.training.own_bodies.folder import read_own_bodies
from fitter.training.own_bodies.mesh_files import MeshFile, write_obj
from tests.unit.training.own_bodies.bodies_folder import (
    AXES,
    DECLARED,
    packaged,
    posed_body,
    random_shapes,
    template,
    write_bodies,
)

SHAPES = random_shapes(4)


@pytest.fixture
def folder(tmp_path) -> Path:
    write_bodies(tmp_path, SHAPES)
    return tmp_path


def read(folder: Path):
    return read_own_bodies(folder, template())


def assert_refused(folder: Path, place: str, *words: str) -> None:
    with pytest.raises(MeshFolderError) as caught:
        read(folder)
    assert caught.value.place == place
    for word in words:
        assert word in str(caught.value)
    assert caught.value.remedy.endswith((".", "there."))


def change(folder: Path, name: str, changed) -> None:
    path = folder / "rest" / f"{name}.npy"
    np.save(path, changed(np.load(path)))


def declare(folder: Path, **entries: object) -> None:
    (folder / "bodies.json").write_text(json.dumps(DECLARED | entries))


def add_scan(folder: Path, vertices: np.ndarray, subject: str = "a", pose: str = "sitting") -> None:
    (folder / "posed" / subject).mkdir(parents=True)
    np.save(folder / "posed" / subject / f"{pose}.npy", vertices)


def test_subjects_come_in_alphabetical_order_in_metres(folder):
    bodies = read(folder)
    assert bodies.subjects == ("a", "b", "c", "d")
    np.testing.assert_array_equal(bodies.rest[1], np.load(folder / "rest" / "b.npy"))
    assert bodies.posed == ()
    assert (bodies.source, bodies.licence) == ("drawn for a test", "CC0-1.0")


def test_millimetres_and_other_axes_come_out_as_the_same_bodies(tmp_path, folder):
    """A z-up, y-back export in millimetres, as scanners write it."""
    other = tmp_path / "other"
    axes = {"left": "+x", "up": "+z", "forward": "-y"}
    for path in write_bodies(other, SHAPES, units="mm", axes=axes):
        x, y, z = np.load(path).T
        np.save(path, 1000.0 * np.stack([x, -z, y], axis=1))
    np.testing.assert_allclose(read(other).rest, read(folder).rest, atol=1e-12)


def test_every_kind_of_file_may_stand_beside_the_others(folder):
    vertices = np.load(folder / "rest" / "a.npy")
    (folder / "rest" / "a.npy").unlink()
    mesh = MeshFile(vertices=vertices, triangles=packaged().triangles)
    write_obj(folder / "rest" / "a.OBJ", mesh)
    np.testing.assert_allclose(read(folder).rest[0], vertices, atol=1e-7)


def test_the_digest_knows_the_meshes_and_not_what_else_lies_there(folder):
    first = read(folder).sha256
    (folder / "notes.txt").write_text("measured on a Monday")
    np.savez(folder / "female.npz", unrelated=np.zeros(3))
    assert read(folder).sha256 == first
    change(folder, "a", lambda vertices: vertices + 1e-9)
    assert read(folder).sha256 != first


def test_a_missing_description_says_how_to_write_one(folder):
    (folder / "bodies.json").unlink()
    assert_refused(folder, "bodies.json", "is missing", "template --meshes")


@pytest.mark.parametrize(
    ("entries", "place", "word"),
    [
        ({"units": "yards"}, "bodies.json: units", "m, dm, cm, mm, in, ft"),
        ({"units": 1}, "bodies.json: units", "expected a text"),
        ({"axes": {"left": "+x", "up": "+y"}}, "bodies.json: axes: forward", "is missing"),
        ({"axes": AXES | {"up": "w"}}, "bodies.json: axes: up", "such as +x or -z"),
        ({"axes": AXES | {"up": "+x"}}, "bodies.json: axes", "an axis twice"),
        ({"axes": AXES | {"up": "-y"}}, "bodies.json: axes", "left-handed"),
        ({"source": " "}, "bodies.json: source", "is empty"),
        ({"licence": ""}, "bodies.json: licence", "under which terms"),
        ({"license": "MIT"}, "bodies.json: license", "is not known"),
    ],
)
def test_a_wrong_entry_of_the_description_is_named(folder, entries, place, word):
    declare(folder, **entries)
    assert_refused(folder, place, word)


def test_a_description_that_is_no_json_is_named(folder):
    (folder / "bodies.json").write_text("{units: m}")
    assert_refused(folder, "bodies.json", "is no JSON")


def test_too_few_bodies_are_counted(folder):
    (folder / "rest" / "d.npy").unlink()
    assert_refused(folder, "rest/", "holds 3 bodies, expected 4")


def test_a_folder_without_bodies_at_rest_is_refused(tmp_path):
    (tmp_path / "bodies.json").write_text(json.dumps(DECLARED))
    assert_refused(tmp_path, "rest/", "holds 0 bodies")


def test_two_files_of_one_subject_are_refused(folder):
    np.savez(folder / "rest" / "b.npz", vertices=np.load(folder / "rest" / "b.npy"))
    assert_refused(folder, "rest/b.npz", "second file of b")


def test_the_same_body_under_two_names_is_refused(folder):
    change(folder, "d", lambda _: np.load(folder / "rest" / "b.npy") + 0.2)
    assert_refused(folder, "rest/d.npy", "is the same body as rest/b.npy")


def flipped(vertices: np.ndarray) -> np.ndarray:
    return vertices * [-1.0, 1.0, 1.0]


def turned(degrees: float, axis: int):
    rotation = rotation_matrices(np.radians(degrees) * np.eye(3)[axis][None])[0]
    return lambda vertices: vertices @ rotation.T


def spoilt(vertices: np.ndarray) -> np.ndarray:
    vertices[7, 1] = np.nan
    return vertices


MESH_FAULTS = {
    "a vertex too few": (lambda v: v[:-1], "has 12439 vertices, expected 12440"),
    "no number": (spoilt, "1 vertices that are not finite, the first is 7"),
    "sorted": (lambda v: v[np.lexsort(v.T)], "is not registered to the template"),
    "counted from one": (lambda v: np.roll(v, 1, axis=0), "is not registered to the template"),
    "all in one place": (np.zeros_like, "is not registered to the template"),
    "millimetres": (lambda v: 1000.0 * v, 'with "units": "mm" it would be one'),
    "inches": (lambda v: v / 0.0254, 'with "units": "in" it would be one'),
    "a doll": (lambda v: 0.1 * v, "expected a person"),
    "z up": (turned(90.0, 0), '"up": "+z", "forward": "-y"'),
    "facing back": (turned(180.0, 1), '"left": "-x", "up": "+y", "forward": "-z"'),
    "askew": (turned(45.0, 1), "stands askew"),
    "a mirror image": (flipped, "is a mirror image"),
}


@pytest.mark.parametrize("fault", MESH_FAULTS)
def test_a_body_at_rest_that_is_none_is_named_with_its_cause(folder, fault):
    changed, words = MESH_FAULTS[fault]
    change(folder, "c", changed)
    assert_refused(folder, "rest/c.npy", words)


def test_triangles_of_another_template_are_noticed(folder):
    triangles = packaged().triangles.copy()
    triangles[5] = triangles[5][::-1]
    vertices = np.load(folder / "rest" / "a.npy")
    (folder / "rest" / "a.npy").unlink()
    write_obj(folder / "rest" / "a.obj", MeshFile(vertices=vertices, triangles=triangles))
    assert_refused(folder, "rest/a.obj", "has 1 triangles that are not the template's", "is 5")


def test_scans_know_their_subject_and_the_pose_that_was_given(folder):
    pose = np.zeros((17, 3))
    pose[packaged().part_names.index("left_forearm"), 1] = -0.5
    add_scan(folder, posed_body(SHAPES[1], pose), subject="b")
    (folder / "poses.json").write_text('{"b/sitting": {"left_forearm": [0, -0.5, 0]}}')
    (scan,) = read(folder).posed
    assert (scan.name, scan.subject) == ("b/sitting", 1)
    np.testing.assert_array_equal(scan.pose, pose)


def test_a_pose_turns_with_the_axes_it_is_written_in(tmp_path):
    """A turn about the files' up axis is one about the body's."""
    axes = {"left": "+x", "up": "+z", "forward": "-y"}
    for path in write_bodies(tmp_path, SHAPES, axes=axes):
        x, y, z = np.load(path).T
        np.save(path, np.stack([x, -z, y], axis=1))
    add_scan(tmp_path, np.load(tmp_path / "rest" / "a.npy"))
    (tmp_path / "poses.json").write_text('{"sitting": {"head": [0, 0, 0.3]}}')
    (scan,) = read(tmp_path).posed
    head = packaged().part_names.index("head")
    np.testing.assert_allclose(scan.pose[head], [0.0, 0.3, 0.0], atol=1e-15)


POSES = {
    "of no file": ({"standing": {}}, "poses.json: standing", "is the pose of no file"),
    "of an unknown part": ({"sitting": {"tail": [0, 0, 0]}}, "poses.json: sitting: tail", "left_"),
    "of two numbers": ({"sitting": {"head": [0, 0]}}, "poses.json: sitting: head", "radians"),
    "of words": ({"sitting": {"head": ["0", 0, 0]}}, "poses.json: sitting: head", "three numbers"),
    "as a list": ({"sitting": [0, 0]}, "poses.json: sitting", "expected an object"),
}


@pytest.mark.parametrize("fault", POSES)
def test_a_wrong_pose_is_named(folder, fault):
    poses, place, words = POSES[fault]
    add_scan(folder, posed_body(SHAPES[0], np.zeros((17, 3))))
    (folder / "poses.json").write_text(json.dumps(poses))
    assert_refused(folder, place, words)


def test_a_scan_of_nobody_is_refused(folder):
    add_scan(folder, posed_body(SHAPES[0], np.zeros((17, 3))), subject="stranger")
    assert_refused(folder, "posed/stranger", "has no body at rest of that name")


def test_a_scan_beside_the_subjects_folders_is_refused(folder):
    (folder / "posed").mkdir()
    np.save(folder / "posed" / "a.npy", np.load(folder / "rest" / "a.npy"))
    assert_refused(folder, "posed/a.npy", "posed/SUBJECT/")


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (lambda v: 100.0 * v, "is 100 times as large as its subject at rest"),
        (flipped, "its surface faces inward"),
        (lambda v: v[1:], "has 12439 vertices"),
        (lambda v: v[np.lexsort(v.T)], "is not registered"),
    ],
)
def test_a_scan_that_is_none_is_named_with_its_cause(folder, changed, words):
    add_scan(folder, changed(posed_body(SHAPES[0], np.zeros((17, 3)))))
    assert_refused(folder, "posed/a/sitting.npy", words)
