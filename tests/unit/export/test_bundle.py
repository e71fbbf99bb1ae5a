"""The files of a result, and the lines of its tapes."""

import json

import cv2
import numpy as np
import pytest

from fitter.body.scape import ScapeEvaluator
from fitter.export import tapes_json
from fitter.export.bundle import result_files
from fitter.export.display import png
from fitter.measurement.anthropometry import measuring_body, tape_lines
from fitter.measurement.definitions import Height, Length
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.glb_reader import read_glb
from tests.unit.export.results import CAMERA, result_of
from tests.unit.measurement.made_up import about

ALWAYS = {
    "views/0/body_posed.glb",
    "body_canonical.glb",
    "views/0/segmentation.png",
    "views/0/trimap.png",
    "views/0/overlay.png",
    "views/0/views.png",
}
REFLECTANCE = {"views/0/albedo.png", "views/0/shading.png", "views/0/shading_lambertian.png"}
BEFORE_SHADING = {"views/0/body_posed_se.glb", "body_canonical_se.glb"}
WITH_SHADING = REFLECTANCE | BEFORE_SHADING
ON_THE_PICTURE = {
    "views/0/segmentation.png",
    "views/0/trimap.png",
    "views/0/overlay.png",
} | REFLECTANCE


@pytest.fixture(scope="module")
def model():
    return bar_model()


@pytest.fixture(scope="module")
def image():
    return png(np.full((CAMERA.height, CAMERA.width, 3), 60, dtype=np.uint8))


@pytest.fixture(scope="module")
def files(model, image):
    return result_files(result_of(model), model=model, images=[image])


def levels(content):
    return cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED)


def test_a_fit_with_shading_gives_every_file(files):
    assert set(files) == ALWAYS | WITH_SHADING


def test_a_fit_without_shading_gives_no_reflectance_pictures(model, image):
    assert set(result_files(result_of(model, light=None), model=model, images=[image])) == ALWAYS


def test_pictures_lie_on_the_originals_pixels(files):
    for name in ON_THE_PICTURE:
        assert levels(files[name]).shape[:2] == (CAMERA.height, CAMERA.width), name


def test_the_body_before_shading_lies_beside_the_final_one(files, model):
    for name, moved in (
        ("views/0/body_posed", lambda vertices: vertices - np.array([0.0, 0.0, 0.05])),
        ("body_canonical", lambda vertices: vertices * np.array([0.98, 1.0, 1.0])),
    ):
        final = read_glb(files[f"{name}.glb"])
        outlined = read_glb(files[f"{name}_se.glb"])
        np.testing.assert_allclose(
            outlined.attribute("POSITION"), moved(final.attribute("POSITION")), atol=1e-6
        )
        assert outlined.document["asset"]["extras"]["cues"] == "SE"
        assert "COLOR_0" not in outlined.document["meshes"][0]["primitives"][0]["attributes"]


def test_the_highlight_is_what_distinguishes_blinn_phong_from_lambert(files):
    lambert = levels(files["views/0/shading_lambertian.png"]).astype(int)
    complete = levels(files["views/0/shading.png"]).astype(int)
    assert (complete - lambert).min() >= 0
    assert (complete - lambert).max() > 5


def test_the_same_result_gives_the_same_bytes(files, model, image):
    assert result_files(result_of(model), model=model, images=[image]) == files


DEFINITIONS = (
    Height(about=about("stature"), point=("crown",)),
    Length(about=about("length"), path=(("joint:bottom",), ("joint:top",))),
)


def test_lines_lie_in_the_frame_of_the_canonical_body():
    model = bar_model()
    result = result_of(model)
    measuring = measuring_body(model, ScapeEvaluator(model), DEFINITIONS)
    document = json.loads(tapes_json(result, measuring))
    lowest = result.canonical_vertices[:, 1].min()
    for name, line in tape_lines(measuring, result.person.body.shape).items():
        expected = line - [0.0, lowest, 0.0]
        assert np.array(document["lines"][name]) == pytest.approx(expected, abs=6e-5)
