"""assimp, trimesh and Khronos' validator open every mesh file and find the body where it is."""

import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh

from fitter.body.model import regress
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.export.gltf import body_canonical_glb, body_posed_glb
from tests.external_tools import found, printed
from tests.foreign.artifacts import GLB_FILES, ROUNDING_M, shown_by
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.results import SUN, reflectance_of, result_of


@pytest.fixture(scope="module")
def assimp() -> str:
    return found("assimp", package="assimp-utils")


@pytest.mark.parametrize("name", GLB_FILES)
def test_assimp_finds_body_and_camera(files: Path, assimp: str, name: str):
    shown = shown_by(name, files)
    done = subprocess.run(
        [assimp, "info", str(files / name)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout
    told = dict(re.findall(r"^(\w+(?: \w+)?):? +(\d+|\(.*\))$", done.stdout, re.MULTILINE))
    assert (int(told["Vertices"]), int(told["Faces"])) == (shown.vertices, shown.triangles)
    # It counts lights that no node switches on: those are not compared.
    assert int(told["Cameras"]) == shown.cameras
    assert int(told["Animations"]) == (len(shown.frames) > 1)
    if len(shown.frames) == 1:
        low, high = (
            [float(x) for x in told[key].strip("() ").split()]
            for key in ("Minimum point", "Maximum point")
        )
        assert shown.agrees(low, high)


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


def played(npm_readers: Path, file: Path, *moments: object) -> list[dict]:
    """Bones and vertices in three.js at some times, or with its bones turned."""
    asked = [json.dumps(moment) for moment in moments]
    return json.loads(printed("node", str(npm_readers / "play.js"), str(file), *asked))


@pytest.mark.parametrize("name", sorted(MOVING))
def test_three_plays_the_exact_bodies(files: Path, npm_readers: Path, name: str):
    shown = shown_by(name, files)
    told = json.loads((files / "animation" / "result.json").read_text())
    last = told["frames"] - 1
    times = [frame * told["frame_time_s"] for frame in (0, last // 2, last)]
    for body, moment in zip(shown.frames, played(npm_readers, files / name, *times), strict=True):
        vertices = np.array(moment["vertices"])[: len(body)]
        assert np.linalg.norm(vertices - body, axis=1).max() <= shown.tolerance_m + 1e-4


def test_three_turns_the_bones_of_a_rig_the_right_way(files: Path, npm_readers: Path):
    """In the T-pose, x to the person's left: about z an arm sinks, about x a knee flexes."""
    half = 0.5**0.5
    turned = {
        "mixamorig:LeftArm": [0, 0, -half, half],
        "mixamorig:RightLeg": [half, 0, 0, half],
        "mixamorig:Head": [0, half, 0, half],
    }
    name = "rig/body_skinned.glb"
    still, moved = played(npm_readers, files / name, {}, turned)
    body = shown_by(name, files).frames[0]
    np.testing.assert_allclose(np.array(still["vertices"])[: len(body)], body, atol=ROUNDING_M)
    at, now = still["bones"], moved["bones"]
    arm = np.subtract(at["mixamorig:LeftHand"], at["mixamorig:LeftArm"])
    sunk = np.subtract(now["mixamorig:LeftHand"], now["mixamorig:LeftArm"])
    assert arm[0] > 0.4
    np.testing.assert_allclose(sunk, [arm[1], -arm[0], arm[2]], atol=1e-5)
    assert now["mixamorig:RightFoot"][2] < at["mixamorig:RightFoot"][2] - 0.3, "it goes back"
    assert now["mixamorig:RightHand"] == at["mixamorig:RightHand"]
    vertices = np.array(moved["vertices"])[: len(body)]
    nose = body[:, 2] == body[body[:, 1] > at["mixamorig:Head"][1], 2].max()
    assert vertices[nose, 0].min() > 0.05, "it looks to its left"


def test_three_plays_the_bvh_of_a_motion_as_its_skin(files: Path, npm_readers: Path):
    """Centimetres; joints that only turn stay within 20 mm."""
    seconds = 0.5
    (skin,) = played(npm_readers, files / "animation" / "body_skinned.glb", seconds)
    (bvh,) = played(npm_readers, files / "animation" / "motion.bvh", seconds)
    for name, place in skin["bones"].items():
        assert np.linalg.norm(0.01 * np.array(bvh["bones"][name]) - place) < 0.02, name


def test_a_canonical_body_stands_on_the_ground_and_faces_z(files: Path):
    vertices = trimesh.load_mesh(files / "fit/body_canonical.glb", process=False).vertices
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


LIGHT = "/extensions/KHR_lights_punctual/lights/0"

HINT = 3
"""Severity of what is merely a hint; 0 is an error, 1 a warning, 2 an information."""


def results(model):
    m = len(model.mean_vertices)
    colours = np.random.default_rng(0).uniform(0.0, 1.4, size=(m, 3))
    return {
        "directional light": result_of(model, light=SUN),
        "bright and coloured": result_of(
            model, reflectance=reflectance_of(model, brightest=2.0), albedo_rgb=colours
        ),
        "without shading": result_of(model, light=None),
    }


@pytest.mark.parametrize("name", GLB_FILES)
def test_the_validator_has_nothing_to_say(files: Path, npm_readers: Path, name: str):
    shown = shown_by(name, files)
    report = validated(npm_readers, (files / name).read_bytes())
    assert remarks(report) == []
    assert report["info"]["totalVertexCount"] == shown.vertices
    assert report["info"]["totalTriangleCount"] == shown.triangles
    assert report["info"]["animationCount"] == (len(shown.frames) > 1)


@pytest.mark.parametrize("kind", results(bar_model()))
def test_nor_of_bodies_in_other_light(npm_readers: Path, kind: str):
    model = bar_model()
    result = results(model)[kind]
    assert remarks(validated(npm_readers, body_posed_glb(result.found, model))) == []
    assert remarks(validated(npm_readers, body_canonical_glb(result, model))) == []


def test_the_validator_is_awake(npm_readers: Path):
    """It complains of a damaged file and of a scene that shows nothing."""
    model = bar_model()
    content = body_posed_glb(result_of(model).found, model)
    damaged = content.replace(b'"VEC3"', b'"VEC2"', 1)
    empty = content.replace(b'"nodes":[0,1,2]}', b'"nodfs":[0,1,2]}', 1)
    assert empty != content
    for each in (damaged, empty):
        assert remarks(validated(npm_readers, each))


def remarks(report: dict) -> list[dict]:
    return [
        each
        for each in report["issues"]["messages"]
        if each["severity"] < HINT and (each["code"], each["pointer"]) != ("UNUSED_OBJECT", LIGHT)
    ]


def validated(npm_readers: Path, content: bytes) -> dict:
    done = subprocess.run(
        ["node", "validate.js"], input=content, cwd=npm_readers, capture_output=True, check=True
    )
    return json.loads(done.stdout)
