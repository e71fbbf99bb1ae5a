"""three.js' GLTFLoader finds body and camera in every mesh file, and plays what moves."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from tests.foreign.artifacts import GLB_FILES
from tests.foreign.expected import shown_by


@pytest.mark.parametrize("name", GLB_FILES)
def test_three_js_shows_and_plays_the_body(files: Path, npm_readers: Path, name: str):
    shown = shown_by(name, files)
    told = loaded(npm_readers, files / name)
    (mesh,) = told["meshes"]
    assert (mesh["vertices"], mesh["triangles"]) == (shown.vertices, shown.triangles)
    assert (mesh["morphTargets"], mesh["bones"]) == (shown.morph_targets, shown.bones)
    assert (mesh["texture"] is not None) is shown.texture
    assert len(told["cameras"]) == shown.cameras
    # Their lights are described, not switched on.
    assert told["lights"] == []
    if len(shown.frames) == 1:
        assert shown.agrees(told["bounds"]["min"], told["bounds"]["max"])
        assert told["frames"] == []
        return
    assert len(told["frames"]) == len(shown.frames)
    for number, each in enumerate(told["frames"]):
        assert shown.agrees(each["min"], each["max"], frame=number)


def test_three_js_has_the_camera_of_the_picture_and_the_place_of_the_light(
    files: Path, npm_readers: Path
):
    told = loaded(npm_readers, files / "fit" / "body_posed.glb")
    result = json.loads((files / "fit" / "result.json").read_text())
    (camera,) = told["cameras"]
    asked = result["image_camera"]
    tangent = np.tan(np.radians(camera["fov"]) / 2)
    assert asked["height"] / (2 * tangent) == pytest.approx(asked["focal_length_px"])
    assert camera["aspect"] == pytest.approx(asked["width"] / asked["height"])
    # Column after column.
    place = np.array(camera["matrix"]).reshape(4, 4).T
    assert np.arcsin(-place[1, 2]) == pytest.approx(np.radians(asked["pitch_deg"]), abs=2e-5)
    assert camera["userData"]["cx_px"] == pytest.approx(asked["centre_x"])
    body = np.array(result["body"]["translation_m"]) * [1, -1, -1]
    away = np.array(told["lightNode"]) - (place[:3, :3] @ body + place[:3, 3])
    assert np.linalg.norm(away) == pytest.approx(result["light"]["distance_m"], abs=2e-3)


def test_what_is_known_of_a_file_s_axes_reaches_the_scene(files: Path, npm_readers: Path):
    for name, words in {
        "fit/body_canonical.glb": "faces +z and stands on y = 0",
        "fit/body_posed.glb": "looks along -z",
    }.items():
        frame = loaded(npm_readers, files / name)["extras"]["frame"]
        assert words in frame
        assert frame.startswith("metres")


def loaded(npm_readers: Path, file: Path) -> dict:
    done = subprocess.run(
        ["node", "three.js", str(file)],
        cwd=npm_readers,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
