"""OBJ files read by trimesh, which did not write them, and by assimp if it is there."""

import re
import shutil
import subprocess

import numpy as np
import pytest
import trimesh

from fitter.export.formats import converted
from fitter.observation.pixels import display_from_linear
from tests.unit.export.formats.bodies import KNOWN, MICROMETRE, coloured, plain, textured


def read(content: bytes, folder) -> trimesh.Trimesh:
    path = folder / "body.obj"
    path.write_bytes(content)
    mesh = trimesh.load_mesh(path, process=False)
    assert isinstance(mesh, trimesh.Trimesh)
    return mesh


@pytest.mark.parametrize("name", ["coloured", "plain"])
def test_vertices_and_triangles_are_the_models_in_its_order_in_metres(name, tmp_path):
    known = KNOWN[name]()
    mesh = read(converted(known.glb, "obj"), tmp_path)
    assert np.abs(mesh.vertices - known.vertices).max() < MICROMETRE
    assert np.array_equal(mesh.faces, known.triangles)


def test_colours_are_given_as_they_are_displayed(tmp_path):
    known = coloured()
    mesh = read(converted(known.glb, "obj"), tmp_path)
    shown = mesh.visual.vertex_colors[:, :3] / 255.0
    assert np.abs(shown - display_from_linear(known.colours)).max() < 0.003
    assert read(converted(plain().glb, "obj"), tmp_path).visual.kind is None


def rows(content: bytes, keyword: str) -> np.ndarray:
    lines = (line.split() for line in content.decode().splitlines())
    return np.array([values for first, *values in lines if first == keyword], float)


def test_normals_point_outward_vertex_by_vertex():
    known = plain()
    normals = rows(converted(known.glb, "obj"), "vn")
    expected = trimesh.Trimesh(known.vertices, known.triangles, process=False).vertex_normals
    assert np.einsum("md,md->m", normals, expected).min() > 0.9


def test_seams_of_a_texture_split_no_vertex():
    known = textured()
    content = converted(known.glb, "obj")
    vertices = rows(content, "v")
    assert vertices.shape == known.vertices.shape
    assert np.abs(vertices - known.vertices).max() < MICROMETRE
    corners = np.array(re.findall(r"(\d+)/\d+/\d+", content.decode()), int)
    assert np.array_equal(corners.reshape(-1, 3) - 1, known.triangles)


def test_each_corner_shows_its_own_place_of_the_picture(tmp_path):
    known = textured()
    (tmp_path / "texture.png").write_bytes(known.picture)
    (tmp_path / "body_textured.mtl").write_bytes(converted(known.glb, "mtl"))
    mesh = read(converted(known.glb, "obj"), tmp_path)
    # Where one vertex shows two places of the picture the reader makes two of it.
    assert np.abs(mesh.triangles - known.vertices[known.triangles]).max() < MICROMETRE
    texels = known.texels[known.texel_triangles]
    assert np.abs(mesh.visual.uv[mesh.faces] - texels).max() < MICROMETRE
    assert mesh.visual.material.image.size == (64, 64)


@pytest.mark.skipif(shutil.which("assimp") is None, reason="no assimp to read the file with")
@pytest.mark.parametrize("name", KNOWN)
def test_assimp_finds_the_same_box_and_triangles(name, tmp_path):
    known = KNOWN[name]()
    for ending in ("obj", "ply", "stl"):
        path = tmp_path / f"body.{ending}"
        path.write_bytes(converted(known.glb, ending))
        told = subprocess.run(
            ["assimp", "info", str(path), "--raw"], capture_output=True, text=True, check=True
        ).stdout
        assert re.search(rf"Faces:\s+{len(known.triangles)}\b", told)
        for word, corner in (
            ("Minimum", known.vertices.min(axis=0)),
            ("Maximum", known.vertices.max(axis=0)),
        ):
            found = re.search(rf"{word} point\s+\((\S+) (\S+) (\S+)\)", told)
            assert found is not None
            assert np.abs(np.array(found.groups(), float) - corner).max() < 2 * MICROMETRE
