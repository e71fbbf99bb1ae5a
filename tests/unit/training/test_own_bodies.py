"""Folders of own bodies, their mesh files and their template: read, or each fault named."""

import json
from pathlib import Path

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.errors import MeshFolderError
from fitter.numerics.rotations import rotation_matrices
from fitter.training.own_bodies.folder import read_own_bodies
from fitter.training.own_bodies.mesh_files import read_mesh, write_obj
from fitter.training.own_bodies.template import (
    TEMPLATE_FILE,
    nearest_mirror,
    read_template,
    same_surface,
    write_template,
)
from tests.unit.training.own_bodies_folder import (
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


VERTICES = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [1.0, 1.25, 0.0], [0.0, 1.0, -2.0]])
TRIANGLES = [[0, 1, 2], [0, 2, 3]]
"""Of one square, as a fan from its first corner."""


def read_file(path):
    return read_mesh(path, place=path.name)


def mesh_file(tmp_path, name: str, content: str | bytes):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


OBJ = "# a square\nv 0 0 0\nv 1 0 0.5\nv 1 1.25 0\nv 0 1 -2\nvn 0 0 1\n"


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f 1 2 3 4\n",
        "f 1//1 2//1 3//1 4//1\n",
        "f -4 -3 -2 -1\n",
        "o second\ng group\nusemtl skin\ns off\nf 1 2 3 4\n",
    ],
)
def test_obj_faces_are_read_however_they_are_mesh_file(tmp_path, faces):
    mesh = read_file(mesh_file(tmp_path, "a.obj", OBJ + faces))
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    assert mesh.triangles is not None
    assert mesh.triangles.tolist() == TRIANGLES


def test_obj_colours_behind_positions_are_passed_over(tmp_path):
    mesh = read_file(mesh_file(tmp_path, "a.obj", "v 1 2 3 0.5 0.5 0.5\r\nv 4 5 6 0.1 0.2 0.3\r\n"))
    assert mesh.vertices.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert mesh.triangles is None


def test_vertices_at_one_place_stay_apart_and_in_order(tmp_path):
    mesh = read_file(mesh_file(tmp_path, "a.obj", "v 1 1 1\nv 0 0 0\nv 1 1 1\n"))
    assert mesh.vertices.tolist() == [[1, 1, 1], [0, 0, 0], [1, 1, 1]]


def test_a_written_obj_comes_back(tmp_path):
    write_obj(tmp_path / "a.obj", VERTICES, np.array(TRIANGLES))
    after = read_file(tmp_path / "a.obj")
    np.testing.assert_allclose(after.vertices, VERTICES, atol=1e-7)
    np.testing.assert_array_equal(after.triangles, TRIANGLES)


def test_arrays_are_read_in_double_precision(tmp_path):
    np.save(tmp_path / "a.npy", VERTICES.astype(np.float32))
    found = read_file(tmp_path / "a.npy").vertices
    np.testing.assert_array_equal(found, VERTICES)
    assert found.dtype == np.float64


DAMAGED = {
    "no positions": ("a.obj", b"vn 0 0 1\n", "expected (vertices, 3)"),
    "two numbers": ("a.obj", b"v 1 2 3\nv 1 2\n", "cannot be read as OBJ"),
    "a word": ("a.obj", b"v 1 2 three\n", "three"),
    "not a number": ("a.obj", b"v 1 2 3\nv 1 nan 2\n", "the first is 1"),
    "a face of words": ("a.obj", b"v 1 2 3\nf a b c\n", "cannot be read as OBJ"),
    "no array": ("a.npy", b"text", "cannot be read as NPY"),
}


@pytest.mark.parametrize("case", DAMAGED)
def test_a_damaged_file_is_named_with_what_is_wrong(tmp_path, case):
    name, content, words = DAMAGED[case]
    with pytest.raises(MeshFolderError) as caught:
        read_file(mesh_file(tmp_path, name, content))
    assert str(caught.value).startswith(name)
    assert words in str(caught.value)
    assert caught.value.remedy.endswith(".")


def test_arrays_of_other_shapes_and_kinds_are_refused(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros((5, 2)))
    with pytest.raises(MeshFolderError, match=r"shape \(5, 2\), expected \(vertices, 3\)"):
        read_file(tmp_path / "a.npy")
    np.save(tmp_path / "objects.npy", np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(MeshFolderError, match="cannot be read as NPY"):
        read_file(tmp_path / "objects.npy")


@pytest.fixture(scope="module")
def written(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("written") / TEMPLATE_FILE
    write_template(path, template())
    return path


@pytest.fixture(scope="module")
def arrays(written) -> dict[str, np.ndarray]:
    with np.load(written) as archive:
        return dict(archive)


def refused(tmp_path: Path, arrays: dict[str, np.ndarray], **changed) -> MeshFolderError:
    """The error of a file with some arrays changed, or left out by None."""
    kept = {name: array for name, array in (arrays | changed).items() if array is not None}
    np.savez(tmp_path / TEMPLATE_FILE, **kept)
    with pytest.raises(MeshFolderError) as caught:
        read_template(tmp_path / TEMPLATE_FILE)
    assert caught.value.remedy
    return caught.value


def test_a_written_template_is_read_as_the_same_surface(written):
    before, after = template(), read_template(written)
    np.testing.assert_array_equal(after.vertices, before.vertices)
    assert same_surface(after.mesh, before.mesh)
    assert after.mesh.landmarks.names == before.mesh.landmarks.names
    for rows in ("joint_regressor", "landmarks"):
        found, true = (
            regress(getattr(each.mesh, rows), before.vertices) for each in (after, before)
        )
        np.testing.assert_allclose(found, true, atol=1e-5)
    np.testing.assert_array_equal(after.mesh.uv, before.mesh.uv)
    np.testing.assert_allclose(
        after.mesh.parts.skinning_weights, before.mesh.parts.skinning_weights, atol=1e-6
    )


def test_the_mirror_is_the_nearest_vertex_across():
    found, truth = nearest_mirror(template().vertices), template().mesh.mirror
    np.testing.assert_array_equal(found[found], np.arange(len(found)))
    assert (found == truth).mean() > 0.95


ARRAYS = {
    "a missing array": ("joints", lambda _: None, "is missing"),
    "fractions": ("part_of_triangle", lambda a: a + 0.5, "holds float64"),
    "a short list of parts": ("part_of_triangle", lambda a: a[:2], "has shape (2,)"),
    "a part without skin": ("part_of_triangle", lambda a: np.maximum(a, 1), "each of pelvis"),
    "weights of another shape": ("skinning_weights", lambda a: a[:, :3], "expected (12440, 17)"),
    "weights that are no shares": ("skinning_weights", lambda a: 2.0 * a, "sums to 2 at vertex"),
    "rows that do not sum to one": ("joints", lambda a: 2.0 * a, "weigh pelvis by 2 in all"),
    "landmarks without a name": ("landmark_names", lambda a: a[1:], "expected (38, 12440)"),
    "triangles beyond the mesh": ("triangles", lambda a: a + 1, "beyond the 12440 vertices"),
    "inside out": ("triangles", lambda a: a[:, ::-1], "inside out"),
}


@pytest.mark.parametrize("fault", ARRAYS)
def test_a_wrong_array_is_named(tmp_path, arrays, fault):
    name, changed, words = ARRAYS[fault]
    error = refused(tmp_path, arrays, **{name: changed(arrays[name])})
    assert words in str(error)
    assert error.place.startswith(f"{TEMPLATE_FILE}: ")


def test_all_missing_landmarks_are_named_at_once(tmp_path, arrays):
    kept = ~np.isin(arrays["landmark_names"], ["navel", "left_toe"])
    changed = {name: arrays[name][kept] for name in ("landmark_names", "landmarks")}
    error = refused(tmp_path, arrays, **changed)
    assert error.place == f"{TEMPLATE_FILE}: landmark_names"
    assert "left_toe" in error.reason
    assert "navel" in error.reason


def test_a_file_that_is_no_archive_is_named(tmp_path):
    (tmp_path / TEMPLATE_FILE).write_text("PK")
    with pytest.raises(MeshFolderError, match="cannot be read"):
        read_template(tmp_path / TEMPLATE_FILE)
