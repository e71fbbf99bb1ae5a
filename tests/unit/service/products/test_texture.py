"""The picture, its albedo or a painted atlas on the body."""

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from api_schemas.products.bodies import LEAST_OWN_TEXTURE, TEXTURE_SIZES
from fitter.applications.own_texture import LEAST_SIDE
from fitter.applications.texture import SIZES
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import Light, Reflectance
from fitter.vocabulary.choices import LightKind
from service.compute.tasks import UnusableInputError
from service.jobs.inputs import PERSON, TEXTURE
from tests.unit.export.glb_reader import read_glb
from tests.unit.service.products.samples import made, person, png


def test_a_texture_with_its_light_divided_out_needs_a_fit_with_shading():
    with pytest.raises(UnusableInputError) as caught:
        made(kind="texture", colours="albedo")
    assert caught.value.error.field == "colours"


def lit_person() -> bytes:
    vertices = len(load_body_model(packaged_model_path("female")).mean_vertices)
    return replace(
        person(),
        light=Light(kind=LightKind.POINT, azimuth=0.4, elevation=0.3, distance=2.0),
        reflectance=Reflectance(
            albedo=np.full(vertices, 0.5),
            specularity=np.zeros(vertices),
            ambient=0.1,
            specular_exponent=10.0,
        ),
    ).to_bytes()


@pytest.mark.parametrize(
    ("fitted", "extensions"),
    [(lambda: person().to_bytes(), []), (lit_person, ["KHR_lights_punctual"])],
    ids=["without light", "with light"],
)
def test_a_texture_of_one_s_own_is_albedo_in_the_light_of_the_fit(fitted, extensions):
    painted = png(96, 96, level=131)
    output = made(
        files={TEXTURE: painted, PERSON: fitted()}, kind="texture", colours="own", size=512
    )
    assert set(output.files) == {"body_textured.glb", "texture.png", "atlas.png"}
    result = output.result.model_dump()
    assert (result["colours"], result["size"], result["scale"]) == ("own", 96, 1.0)
    assert (result["seen_share"], result["mirrored_share"]) == (0.0, 0.0)
    texture = np.asarray(Image.open(io.BytesIO(output.files["texture.png"])))
    assert texture.shape == (96, 96, 3)
    assert set(np.unique(texture)) == {0, 131}
    assert Image.open(io.BytesIO(output.files["atlas.png"])).mode == "RGBA"
    glb = read_glb(output.files["body_textured.glb"])
    assert glb.document.get("extensionsUsed", []) == extensions
    view = glb.document["bufferViews"][glb.document["images"][0]["bufferView"]]
    start = view["byteOffset"]
    stored = glb.binary[start : start + view["byteLength"]]
    assert stored == output.files["texture.png"]


@pytest.mark.parametrize("content", [png(96, 96)[:-40], png(96, 64), b"\x89PNG\r\n\x1a\n"])
def test_a_texture_that_cannot_be_laid_on_the_body_is_refused_with_the_part(content):
    with pytest.raises(UnusableInputError) as caught:
        made(files={TEXTURE: content}, kind="texture", colours="own")
    assert caught.value.error.field == "texture"
    assert caught.value.error.remedy


def test_the_sizes_of_textures_on_the_wire_are_the_fitter_s():
    assert TEXTURE_SIZES == SIZES
    assert LEAST_OWN_TEXTURE == LEAST_SIDE
