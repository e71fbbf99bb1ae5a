"""Files in other formats, by the service as a user starts it, read by other people's readers."""

import csv
import io
from pathlib import Path

import httpx
import numpy as np
import plyfile
import pytest
import stl.mesh
import trimesh

from tests.e2e.service import REPOSITORY, ended_job

SAMPLE = REPOSITORY / "service" / "demo_data"
MICROMETRE = 1e-6
BODIES = ("views/0/body_posed", "body_canonical")


@pytest.fixture(scope="module")
def client(service: httpx.Client) -> httpx.Client:
    return service


@pytest.fixture(scope="module")
def fit(client: httpx.Client, finished_fit: str) -> dict:
    return client.get(f"/v1/fits/{finished_fit}").raise_for_status().json()


def mesh_of(glb: bytes) -> tuple[np.ndarray, np.ndarray]:
    """Vertices, where its nodes put them, and triangles of a GLB with one mesh."""
    scene = trimesh.load_scene(io.BytesIO(glb), file_type="glb", process=False)
    (node,) = scene.graph.nodes_geometry
    turned, name = scene.graph[node]
    mesh = scene.geometry[name]
    return trimesh.transform_points(mesh.vertices, turned), np.asarray(mesh.faces)


def same(read: np.ndarray, vertices: np.ndarray) -> bool:
    return read.shape == vertices.shape and np.abs(read - vertices).max() < MICROMETRE


@pytest.mark.parametrize("name", BODIES)
def test_every_format_holds_the_mesh_of_the_glb(client: httpx.Client, fit, tmp_path: Path, name):
    files = f"{fit['links']['self']}/files/{name}"
    vertices, triangles = mesh_of(client.get(f"{files}.glb").content)
    for ending in ("obj", "ply", "stl"):
        answer = client.get(f"{files}.{ending}").raise_for_status()
        (tmp_path / f"body.{ending}").write_bytes(answer.content)

    obj = trimesh.load_mesh(tmp_path / "body.obj", process=False)
    assert same(obj.vertices, vertices)
    assert np.array_equal(obj.faces, triangles)
    assert obj.is_watertight

    ply = plyfile.PlyData.read(tmp_path / "body.ply")
    assert same(np.column_stack([ply["vertex"][axis] for axis in "xyz"]), vertices)
    assert np.array_equal(np.vstack(ply["face"]["vertex_indices"]), triangles)

    assert same(stl.mesh.Mesh.from_file(str(tmp_path / "body.stl")).vectors, vertices[triangles])


def test_measurements_are_the_results_with_their_units(client: httpx.Client, fit):
    result = client.get(fit["links"]["result"]).json()
    table = client.get(f"{fit['links']['self']}/files/measurements.csv").text
    rows = list(csv.DictReader(io.StringIO(table, newline="")))
    assert [(row["name"], row["unit"], float(row["value"])) for row in rows] == [
        (each["name"], each["unit"], each["value"]) for each in result["measurements"]
    ]


def test_a_textured_body_keeps_the_models_vertices_and_its_texture(
    client: httpx.Client, fit, tmp_path: Path
):
    posed, triangles = mesh_of(
        client.get(f"{fit['links']['self']}/files/views/0/body_posed.glb").content
    )
    asked = {"kind": "texture", "colours": "picture", "size": 512}
    job = ended_job(client, client.post(fit["links"]["products"], json=asked))
    for name in ("body_textured.obj", "body_textured.mtl", "texture.png"):
        answer = client.get(f"{job['links']['self']}/files/{name}").raise_for_status()
        (tmp_path / name).write_bytes(answer.content)
    rows = (tmp_path / "body_textured.obj").read_text().splitlines()
    vertices = np.array([row.split()[1:] for row in rows if row.startswith("v ")], float)
    assert same(vertices, posed)
    read = trimesh.load_mesh(tmp_path / "body_textured.obj", process=False)
    assert same(read.triangles, posed[triangles])
    assert read.visual.material.image.size == (512, 512)
