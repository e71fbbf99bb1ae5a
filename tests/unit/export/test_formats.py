"""Other formats of a GLB, read by programs that did not write them, and the same again."""

import io
import re
import subprocess
import sys

import numpy as np
import plyfile
import pytest
import stl.mesh
import trimesh

from fitter.applications.animated_glb import morphed_glb, skin_of, skinned_glb
from fitter.applications.motion import grounded, motion_of_cycle, moving_body
from fitter.applications.principal_frames import principal_frames
from fitter.applications.skeleton import skeleton_of
from fitter.applications.walk import stride_of
from fitter.export.formats import FORMATS, converted
from fitter.observation.pixels import display_from_linear
from fitter.vocabulary.choices import BoneNames
from service.api.files import MATERIAL, MESH_FORMATS, renditions
from service.jobs.records import StoredBlob
from tests.unit.applications.bodies import packaged
from tests.unit.export.known_files import KNOWN, MICROMETRE, coloured, plain, textured


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


def test_what_the_service_offers_is_what_can_be_written():
    assert set(MESH_FORMATS) | set(MATERIAL) == set(FORMATS)


def test_what_another_writer_may_write_otherwise_has_another_tag(monkeypatch):
    stored = {"body.glb": StoredBlob(digest="a", media_type="model/gltf-binary")}
    before = {name: each.tag for name, each in renditions(stored)}
    monkeypatch.setattr("service.api.files.VERSION", "another")
    after = {name: each.tag for name, each in renditions(stored)}
    assert {name for name in before if before[name] == after[name]} == set(stored)
    assert len(set(before.values())) == len(before) == 1 + len(MESH_FORMATS)


def test_another_process_writes_the_same_bytes(tmp_path):
    (tmp_path / "coloured.glb").write_bytes(coloured().glb)
    (tmp_path / "textured.glb").write_bytes(textured().glb)
    program = """
import hashlib, sys
from pathlib import Path
from fitter.export.formats import FORMATS, converted
for name in ("coloured", "textured"):
    glb = (Path(sys.argv[1]) / f"{name}.glb").read_bytes()
    for ending in FORMATS:
        if (name, ending) != ("coloured", "mtl"):
            print(hashlib.sha256(converted(glb, ending)).hexdigest())
"""
    runs = [
        subprocess.run(
            [sys.executable, "-c", program, str(tmp_path)],
            env={"PYTHONHASHSEED": seed, "PYTHONPATH": ":".join(sys.path)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for seed in ("1", "2")
    ]
    assert runs[0] == runs[1]
    assert len(set(runs[0])) == 7


def test_a_material_is_that_of_a_texture():
    assert b"map_Kd texture.png" in converted(textured().glb, "mtl")


@pytest.fixture(scope="module")
def body():
    return packaged("male")


@pytest.fixture(scope="module")
def moving(body):
    """A stride that begins turned away and off the middle."""
    motion = motion_of_cycle(stride_of(body.rig), body.rig, frames=stride_of(body.rig).frames)
    motion.poses[:, 0, 1] = np.linspace(1.0, 2.0, len(motion.poses))
    motion.roots[:, 0] += 0.5
    return grounded(moving_body(body.evaluator, body.shape, motion), body.model)


def vertices_of(glb: bytes) -> np.ndarray:
    read = trimesh.load_mesh(io.BytesIO(converted(glb, "ply")), file_type="ply", process=False)
    return read.vertices


def test_morph_targets_give_the_exact_first_body(body, moving):
    exact = principal_frames(moving.shapes)
    glb = morphed_glb(moving, exact, body.model, reflectance=None, albedo_rgb=None)
    np.testing.assert_allclose(vertices_of(glb), moving.vertices(0), atol=2e-6)


def test_bones_give_the_first_body_within_the_skins_error(body, moving):
    skeleton = skeleton_of(body.evaluator, body.shape, body.rig, BoneNames.MAQUETTE)
    skin = skin_of(moving, body.model, skeleton)
    glb = skinned_glb(moving, skin, body.model, reflectance=None, albedo_rgb=None)
    away = np.linalg.norm(vertices_of(glb) - moving.vertices(0), axis=1)
    assert away.max() <= skin.largest_error_m + 1e-5
    bound = np.linalg.norm(skin.vertices - moving.vertices(0), axis=1)
    assert away.max() < 0.2 * bound.min()
