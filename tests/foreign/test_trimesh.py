"""trimesh opens every mesh file as its users do: by load_mesh, and by the scene's to_mesh."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from fitter.body.model import regress
from fitter.body.storage import load_body_model, packaged_model_path
from tests.foreign.artifacts import GLB_FILES
from tests.foreign.expected import ROUNDING_M, shown_by

MOVING = {name for name in GLB_FILES if "animation/" in name}


@pytest.mark.parametrize("name", GLB_FILES)
def test_load_mesh_and_to_mesh_give_the_body(files: Path, name: str):
    shown = shown_by(name, files)
    loaded = trimesh.load_mesh(files / name, process=False)
    for mesh in (loaded, trimesh.load_scene(files / name, process=False).to_mesh()):
        assert (len(mesh.vertices), len(mesh.faces)) == (shown.vertices, shown.triangles)
        assert mesh.volume > 0.0, "the surface is not inside out"


@pytest.mark.parametrize("name", [each for each in GLB_FILES if each not in MOVING])
def test_load_mesh_puts_the_body_where_it_is(files: Path, name: str):
    shown = shown_by(name, files)
    mesh = trimesh.load_mesh(files / name, process=False)
    assert shown.agrees(*mesh.bounds)
    if not shown.texture:
        np.testing.assert_allclose(mesh.vertices, shown.frames[0], atol=ROUNDING_M)


def test_the_skin_stands_on_the_ground_for_readers_that_know_no_skins(files: Path):
    mesh = trimesh.load_mesh(files / "animation/body_skinned.glb", process=False)
    assert mesh.bounds[0, 1] == pytest.approx(0.0, abs=0.01)
    assert mesh.volume == pytest.approx(
        trimesh.load_mesh(files / "animation/body_animated.glb", process=False).volume, rel=0.02
    )


def test_a_stranger_s_volume_is_the_weight_that_was_measured(files: Path):
    mesh = trimesh.load_mesh(files / "fit/body_canonical.glb", process=False)
    assert mesh.is_watertight
    result = json.loads((files / "fit" / "result.json").read_text())
    weight = {each["name"]: each["value"] for each in result["measurements"]}["weight"]
    assert 1000.0 * mesh.volume == pytest.approx(weight, rel=1e-4)


@pytest.mark.parametrize("name", ["fit/body_canonical.glb"])
def test_a_canonical_body_stands_on_the_ground_and_faces_z(files: Path, name: str):
    vertices = trimesh.load_mesh(files / name, process=False).vertices
    result = json.loads((files / "fit" / "result.json").read_text())
    model = load_body_model(packaged_model_path(result["gender"]))
    at = dict(zip(model.landmarks.names, regress(model.landmarks, vertices), strict=True))
    assert vertices[:, 1].min() == 0.0
    assert vertices[:, 1].max() == pytest.approx(result["height_m"], abs=0.02)
    for side in ("left", "right"):
        assert at[f"{side}_toe"][1] < 0.1, "feet are below"
        assert at[f"{side}_toe"][2] > at[f"{side}_heel"][2] + 0.1, "toes point ahead"
    assert at["nose"][2] > at["left_ear"][2] + 0.05, "the face looks ahead"
    assert at["left_shoulder"][0] > at["right_shoulder"][0] + 0.2, "left is where +x is"
