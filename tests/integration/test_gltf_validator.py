"""Khronos' own validator reads every GLB we write without an error or a warning."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fitter.applications.animated_glb import morphed_glb, skinned_glb
from fitter.applications.motion import Motion, moving_body
from fitter.applications.principal_frames import principal_frames
from fitter.applications.skin import skin_of
from fitter.body.scape import ScapeEvaluator
from fitter.export.gltf import body_canonical_glb, body_posed_glb
from tests.npm_packages import installed
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.results import SUN, reflectance_of, result_of

TOOL = Path(__file__).parent.parent / "gltf_validator"


@pytest.fixture(scope="module")
def validator():
    installed(TOOL)

    def validate(content: bytes) -> dict:
        done = subprocess.run(
            ["node", "validate.js"], input=content, cwd=TOOL, capture_output=True, check=True
        )
        return json.loads(done.stdout)

    return validate


def complaints(report):
    """Messages that are errors (0) or warnings (1)."""
    return [m for m in report["issues"]["messages"] if m["severity"] <= 1]


def results(model):
    m = len(model.mean_vertices)
    colours = np.random.default_rng(0).uniform(0.0, 1.4, size=(m, 3))
    return {
        "point light": result_of(model),
        "directional light": result_of(model, light=SUN),
        "bright and coloured": result_of(
            model, reflectance=reflectance_of(model, brightest=2.0), albedo_rgb=colours
        ),
        "without shading": result_of(model, light=None),
    }


@pytest.mark.parametrize("write", [body_posed_glb, body_canonical_glb])
@pytest.mark.parametrize("kind", results(bar_model()))
def test_khronos_validator_has_no_complaint(validator, write, kind):
    model = bar_model()
    report = validator(write(results(model)[kind], model))
    assert complaints(report) == []
    assert report["info"]["totalVertexCount"] == len(model.mean_vertices)
    assert report["info"]["totalTriangleCount"] == len(model.triangles)


def animated(model, *, skinned):
    """A few frames of the bar bending."""
    rng = np.random.default_rng(1)
    motion = Motion(
        frame_time_s=1 / 30,
        poses=0.3 * rng.standard_normal((5, len(model.part_names), 3)),
        roots=rng.standard_normal((5, 3)),
        lifts_m=np.zeros(5),
    )
    body = moving_body(ScapeEvaluator(model), np.zeros(len(model.shape_basis)), motion)
    reflectance = reflectance_of(model)
    if skinned:
        skin = skin_of(body, model)
        return skinned_glb(body, skin, model, reflectance=reflectance, albedo_rgb=None)
    frames = principal_frames(body.shapes)
    return morphed_glb(body, frames, model, reflectance=reflectance, albedo_rgb=None)


@pytest.mark.parametrize("skinned", [False, True])
def test_khronos_validator_has_no_complaint_of_animations(validator, skinned):
    report = validator(animated(bar_model(), skinned=skinned))
    assert complaints(report) == []
    assert report["info"]["animationCount"] == 1
    assert report["info"]["hasMorphTargets"] is not skinned
    assert report["info"]["hasSkins"] is skinned


def test_the_validator_is_awake(validator):
    """A damaged file must be complained of, or the test above would mean nothing."""
    model = bar_model()
    content = body_posed_glb(result_of(model), model).replace(b'"VEC3"', b'"VEC2"', 1)
    assert complaints(validator(content))
