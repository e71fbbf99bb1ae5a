import numpy as np
import pytest

from fitter.errors import MeshFolderError
from fitter.training.own_bodies.mesh_files import read_mesh, write_obj

VERTICES = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [1.0, 1.25, 0.0], [0.0, 1.0, -2.0]])
TRIANGLES = [[0, 1, 2], [0, 2, 3]]
"""Of one square, as a fan from its first corner."""


def read(path):
    return read_mesh(path, place=path.name)


def written(tmp_path, name: str, content: str | bytes):
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
def test_obj_faces_are_read_however_they_are_written(tmp_path, faces):
    mesh = read(written(tmp_path, "a.obj", OBJ + faces))
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    assert mesh.triangles is not None
    assert mesh.triangles.tolist() == TRIANGLES


def test_obj_colours_behind_positions_are_passed_over(tmp_path):
    mesh = read(written(tmp_path, "a.obj", "v 1 2 3 0.5 0.5 0.5\r\nv 4 5 6 0.1 0.2 0.3\r\n"))
    assert mesh.vertices.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert mesh.triangles is None


def test_vertices_at_one_place_stay_apart_and_in_order(tmp_path):
    mesh = read(written(tmp_path, "a.obj", "v 1 1 1\nv 0 0 0\nv 1 1 1\n"))
    assert mesh.vertices.tolist() == [[1, 1, 1], [0, 0, 0], [1, 1, 1]]


def test_a_written_obj_comes_back(tmp_path):
    write_obj(tmp_path / "a.obj", VERTICES, np.array(TRIANGLES))
    after = read(tmp_path / "a.obj")
    np.testing.assert_allclose(after.vertices, VERTICES, atol=1e-7)
    np.testing.assert_array_equal(after.triangles, TRIANGLES)


def test_arrays_are_read_in_double_precision(tmp_path):
    np.save(tmp_path / "a.npy", VERTICES.astype(np.float32))
    found = read(tmp_path / "a.npy").vertices
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
        read(written(tmp_path, name, content))
    assert str(caught.value).startswith(name)
    assert words in str(caught.value)
    assert caught.value.remedy.endswith(".")


def test_arrays_of_other_shapes_and_kinds_are_refused(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros((5, 2)))
    with pytest.raises(MeshFolderError, match=r"shape \(5, 2\), expected \(vertices, 3\)"):
        read(tmp_path / "a.npy")
    np.save(tmp_path / "objects.npy", np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(MeshFolderError, match="cannot be read as NPY"):
        read(tmp_path / "objects.npy")
