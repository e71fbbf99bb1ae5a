"""PLY and STL files, which trimesh writes, read by plyfile and by numpy-stl."""

import io

import numpy as np
import plyfile
import pytest
import stl.mesh

from fitter.export.formats import converted
from fitter.observation.pixels import display_from_linear
from tests.unit.export.formats.bodies import KNOWN, MICROMETRE, coloured, plain


def columns(element, *names: str) -> np.ndarray:
    return np.column_stack([element[name] for name in names])


@pytest.mark.parametrize("name", KNOWN)
def test_a_ply_has_the_models_vertices_and_triangles_in_its_order_in_metres(name):
    known = KNOWN[name]()
    ply = plyfile.PlyData.read(io.BytesIO(converted(known.glb, "ply")))
    vertices = columns(ply["vertex"], "x", "y", "z")
    assert np.abs(vertices - known.vertices).max() < MICROMETRE
    assert np.array_equal(np.vstack(ply["face"]["vertex_indices"]), known.triangles)


def test_a_ply_has_normals_and_colours_as_they_are_displayed():
    known = coloured()
    vertex = plyfile.PlyData.read(io.BytesIO(converted(known.glb, "ply")))["vertex"]
    normals = columns(vertex, "nx", "ny", "nz")
    assert np.abs(np.linalg.norm(normals, axis=1) - 1.0).max() < 1e-5
    shown = columns(vertex, "red", "green", "blue") / 255.0
    assert np.abs(shown - display_from_linear(known.colours)).max() < 0.003
    assert (vertex["alpha"] == 255).all()
    neutral = plyfile.PlyData.read(io.BytesIO(converted(plain().glb, "ply")))["vertex"]
    assert "red" not in neutral.data.dtype.names


@pytest.mark.parametrize("name", KNOWN)
def test_an_stl_has_the_models_triangles_in_its_order_in_metres(name):
    known = KNOWN[name]()
    read = stl.mesh.Mesh.from_file("body.stl", fh=io.BytesIO(converted(known.glb, "stl")))
    assert np.abs(read.vectors - known.vertices[known.triangles]).max() < MICROMETRE
    outward = np.cross(
        read.vectors[:, 1] - read.vectors[:, 0], read.vectors[:, 2] - read.vectors[:, 0]
    )
    assert np.einsum("fd,fd->f", outward, read.normals).min() >= 0.0
