import struct

import numpy as np
import pytest

from fitter.errors import MeshFolderError
from fitter.training.own_bodies.mesh_files import MeshFile, read_mesh, write_obj

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
    assert mesh.uv is None


def test_obj_colours_behind_positions_are_passed_over(tmp_path):
    mesh = read(written(tmp_path, "a.obj", "v 1 2 3 0.5 0.5 0.5\r\nv 4 5 6 0.1 0.2 0.3\r\n"))
    assert mesh.vertices.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert mesh.triangles is None


def test_vertices_at_one_place_stay_apart_and_in_order(tmp_path):
    mesh = read(written(tmp_path, "a.obj", "v 1 1 1\nv 0 0 0\nv 1 1 1\n"))
    assert mesh.vertices.tolist() == [[1, 1, 1], [0, 0, 0], [1, 1, 1]]


def test_a_written_obj_comes_back_with_its_texture(tmp_path):
    before = MeshFile(
        vertices=VERTICES,
        triangles=np.array(TRIANGLES),
        uv=np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]),
        uv_triangles=np.array([[0, 1, 2], [2, 1, 0]]),
    )
    write_obj(tmp_path / "a.obj", before)
    after = read(tmp_path / "a.obj")
    for name in ("vertices", "triangles", "uv", "uv_triangles"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), atol=1e-7)


def ply_header(form: str, faces: str = "element face 1\nproperty list uchar int vertex_indices\n"):
    return (
        f"ply\nformat {form} 1.0\ncomment made by händ\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
        f"{faces}end_header\n"
    ).encode()


def binary_ply(form: str, mark: str) -> bytes:
    rows = b"".join(struct.pack(f"{mark}fffB", *vertex, 7) for vertex in VERTICES.tolist())
    return ply_header(form) + rows + struct.pack(f"{mark}Biiii", 4, 0, 1, 2, 3)


def ascii_ply(faces: str) -> bytes:
    rows = "".join(f"{x} {y} {z} 7\n" for x, y, z in VERTICES.tolist())
    return ply_header("ascii") + rows.encode() + faces.encode()


@pytest.mark.parametrize(
    "content",
    [
        binary_ply("binary_little_endian", "<"),
        binary_ply("binary_big_endian", ">"),
        ascii_ply("4 0 1 2 3\n"),
    ],
    ids=["little", "big", "ascii"],
)
def test_ply_files_of_all_three_forms_say_the_same(tmp_path, content):
    mesh = read(written(tmp_path, "a.ply", content))
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    assert mesh.triangles is not None
    assert mesh.triangles.tolist() == TRIANGLES


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_a_ply_file_may_hold_no_faces(tmp_path, form):
    faces = "element face 0\nproperty list uchar int vertex_indices\n"
    rows = (
        "".join(f"{x} {y} {z} 7\n" for x, y, z in VERTICES.tolist()).encode()
        if form == "ascii"
        else b"".join(struct.pack("<fffB", *vertex, 7) for vertex in VERTICES.tolist())
    )
    mesh = read(written(tmp_path, "a.ply", ply_header(form, faces) + rows))
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    assert mesh.triangles is None


def test_ply_polygons_of_differing_size_leave_the_vertices(tmp_path):
    header = ply_header("ascii").replace(b"face 1", b"face 2")
    content = header + ascii_ply("")[len(ply_header("ascii")) :] + b"3 0 1 2\n4 0 1 2 3\n"
    mesh = read(written(tmp_path, "a.ply", content))
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    assert mesh.triangles is None


def test_arrays_are_read_from_npy_and_npz(tmp_path):
    np.save(tmp_path / "a.npy", VERTICES.astype(np.float32))
    np.savez(tmp_path / "a.npz", vertices=VERTICES, other=np.zeros(3))
    for name in ("a.npy", "a.npz"):
        np.testing.assert_array_equal(read(tmp_path / name).vertices, VERTICES)


LITTLE = binary_ply("binary_little_endian", "<")

DAMAGED = {
    "no positions": ("a.obj", b"vn 0 0 1\n", "expected (vertices, 3)"),
    "two numbers": ("a.obj", b"v 1 2 3\nv 1 2\n", "cannot be read as OBJ"),
    "a word": ("a.obj", b"v 1 2 three\n", "three"),
    "not a number": ("a.obj", b"v 1 2 3\nv 1 nan 2\n", "the first is 1"),
    "a face of words": ("a.obj", b"v 1 2 3\nf a b c\n", "cannot be read as OBJ"),
    "nothing": ("a.ply", b"", "no PLY header"),
    "another format": ("a.ply", b"solid stl\n", "no PLY header"),
    "an unknown form": ("a.ply", ply_header("binary_middle_endian"), "cannot be read as PLY"),
    "cut vertices": ("a.ply", LITTLE[: len(ply_header("binary_little_endian")) + 20], "PLY"),
    "a cut face": ("a.ply", LITTLE[:-2], "cannot be read as PLY"),
    "missing lines": ("a.ply", ply_header("ascii") + b"0 0 0 7\n", "1 of 4 rows of vertex"),
    "no array": ("a.npy", b"text", "cannot be read as NPY"),
    "no archive": ("a.npz", b"PK", "cannot be read as NPZ"),
}


@pytest.mark.parametrize("case", DAMAGED)
def test_a_damaged_file_is_named_with_what_is_wrong(tmp_path, case):
    name, content, words = DAMAGED[case]
    with pytest.raises(MeshFolderError) as caught:
        read(written(tmp_path, name, content))
    assert str(caught.value).startswith(name)
    assert words in str(caught.value)
    assert caught.value.remedy.endswith(".")


def test_arrays_of_other_shapes_and_names_are_refused(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros((5, 2)))
    with pytest.raises(MeshFolderError, match=r"shape \(5, 2\), expected \(vertices, 3\)"):
        read(tmp_path / "a.npy")
    np.savez(tmp_path / "a.npz", v=VERTICES)
    with pytest.raises(MeshFolderError, match="no array `vertices` among v"):
        read(tmp_path / "a.npz")
    np.save(tmp_path / "objects.npy", np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(MeshFolderError, match="cannot be read as NPY"):
        read(tmp_path / "objects.npy")
