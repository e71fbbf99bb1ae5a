"""Khronos' own validator has nothing to say of any mesh file: no error, warning or information.

But that no node uses the light that is described: that is meant.
"""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fitter.export.gltf import body_canonical_glb, body_posed_glb
from tests.foreign.artifacts import GLB_FILES
from tests.foreign.expected import shown_by
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.results import SUN, reflectance_of, result_of

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
