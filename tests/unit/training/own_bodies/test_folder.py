"""A folder as it should be, and each fault of one: what is said, and of which file."""

import json
from pathlib import Path

import numpy as np
import pytest

from fitter.errors import MeshFolderError
from fitter.numerics.rotations import rotation_matrices
from fitter.training.own_bodies.folder import read_own_bodies
from fitter.training.own_bodies.mesh_files import write_obj
from tests.unit.training.own_bodies.bodies_folder import (
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


def add_scan(folder: Path, vertices: np.ndarray, subject: str = "a", pose: str = "sitting") -> None:
    (folder / "posed" / subject).mkdir(parents=True)
    np.save(folder / "posed" / subject / f"{pose}.npy", vertices)


def test_subjects_come_in_alphabetical_order_in_metres(folder):
    bodies = read(folder)
    assert bodies.subjects == ("a", "b", "c", "d")
    np.testing.assert_array_equal(bodies.rest[1], np.load(folder / "rest" / "b.npy"))
    assert bodies.scans == ()
    assert (bodies.source, bodies.licence) == ("drawn for a test", "CC0-1.0")


def test_every_kind_of_file_may_stand_beside_the_others(folder):
    vertices = np.load(folder / "rest" / "a.npy")
    (folder / "rest" / "a.npy").unlink()
    write_obj(folder / "rest" / "a.OBJ", vertices, packaged().triangles)
    np.testing.assert_allclose(read(folder).rest[0], vertices, atol=1e-7)


def test_a_missing_description_says_how_to_write_one(folder):
    (folder / "bodies.json").unlink()
    assert_refused(folder, "bodies.json", "cannot be read", "template --meshes")


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ('{"source": " ", "licence": "CC0"}', "source or licence empty"),
        ('{"source": "us", "license": "CC0"}', "'licence'"),
        ("{source: us}", "cannot be read"),
        ("[]", "cannot be read"),
    ],
)
def test_a_description_that_says_too_little_is_refused(folder, text, word):
    (folder / "bodies.json").write_text(text)
    assert_refused(folder, "bodies.json", word)


def test_too_few_bodies_are_counted(folder):
    (folder / "rest" / "d.npy").unlink()
    assert_refused(folder, "rest/", "holds 3 bodies, expected 4")


def test_a_folder_without_bodies_at_rest_is_refused(tmp_path):
    (tmp_path / "bodies.json").write_text(json.dumps(DECLARED))
    assert_refused(tmp_path, "rest/", "holds 0 bodies")


def test_two_files_of_one_subject_are_refused(folder):
    vertices = np.load(folder / "rest" / "b.npy")
    write_obj(folder / "rest" / "b.obj", vertices, packaged().triangles)
    assert_refused(folder, "rest/b.obj", "second file of b")


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
    "millimetres": (lambda v: 1000.0 * v, "divide millimetres by 1000"),
    "a doll": (lambda v: 0.1 * v, "expected a person"),
    "z up": (turned(90.0, 0), "stands along other axes"),
    "askew": (turned(45.0, 1), "stands along other axes"),
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
    write_obj(folder / "rest" / "a.obj", vertices, triangles)
    assert_refused(folder, "rest/a.obj", "has 1 triangles that are not the template's", "is 5")


def test_scans_know_their_subject(folder):
    vertices = posed_body(SHAPES[1], np.zeros((17, 3)))
    add_scan(folder, vertices, subject="b")
    (scan,) = read(folder).scans
    assert scan.subject == 1
    np.testing.assert_array_equal(scan.vertices, vertices)


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
