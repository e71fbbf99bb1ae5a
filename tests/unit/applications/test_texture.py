"""A body is painted, photographed and textured from its photograph: the paint must come back."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
import pytest

from fitter.applications.atlas import atlas_of, drawn_on
from fitter.applications.texture import (
    TexelOrigin,
    Texture,
    albedo_texture,
    linear_picture,
    picture_colours,
    picture_texture,
)
from fitter.body.scape import CAMERA_AXES
from fitter.errors import InvalidInputError
from fitter.export.display import png
from fitter.export.gltf import textured_glb
from fitter.export.gltf_mesh import BodyTexture
from fitter.observation.pixels import display_from_linear, linear_from_display
from fitter.parameters import BodyParameters, Light, Reflectance
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.render.rasterizer import render, shade_image
from fitter.render.reflectance import shading_terms
from fitter.render.shadow import cast_shadow
from fitter.vocabulary.choices import Gender, LightKind
from tests.unit.applications.bodies import packaged
from tests.unit.export.glb_reader import read_glb

CAMERA = Camera(focal_length_px=1000.0, centre_x=300.0, centre_y=400.0, width=600, height=800)
LIGHT = Light(kind=LightKind.POINT, azimuth=0.5, elevation=0.4, distance=2.5)
AMBIENT, GLOSS, EXPONENT = 0.1, 0.05, 12.0


@dataclass(frozen=True, kw_only=True)
class Sitter:
    """A painted person, and the pictures they were photographed in: evenly lit, and by a lamp."""

    person: FittedPerson
    evaluator: object
    paint: np.ndarray
    even: np.ndarray
    lit: np.ndarray


@pytest.fixture(scope="module")
def sitter() -> Sitter:
    body = packaged("female")
    model = body.evaluator.model
    parameters = BodyParameters(
        pose=model.canonical_pose.copy(),
        translation=np.array([0.0, -0.05, 2.9]),
        shape=np.zeros_like(body.shape),
    )
    vertices = body.evaluator.vertices(parameters)
    height = model.mean_vertices[:, 1]
    share = (height - height.min()) / np.ptp(height)
    side = 0.05 + 0.05 * np.tanh(model.mean_vertices[:, 0] / 0.02)
    paint = np.stack([0.3 + 0.4 * share, 0.5 - 0.2 * share + side, 0.3 + 0.0 * share], axis=1)
    luminance = paint @ [0.2126, 0.7152, 0.0722]
    rendering = render(vertices, model.triangles, CAMERA)
    lit = 1.0 - cast_shadow(
        vertices, model.triangles, light=LIGHT, body_centre=parameters.translation
    )
    terms = shading_terms(
        vertices,
        rendering.vertex_normals,
        light=LIGHT,
        body_centre=parameters.translation,
        specular_exponent=EXPONENT,
    )
    direct = terms.diffuse * lit
    around = AMBIENT / np.median(luminance[rendering.vertex_visible])
    brightness = luminance * (direct + around) + GLOSS * terms.specular * lit
    shaded = paint * (brightness / luminance)[:, None]

    def photographed(colours):
        channels = [shade_image(rendering, channel, background=0.9) for channel in colours.T]
        return np.stack(channels, axis=2)

    person = FittedPerson(
        gender=Gender.FEMALE,
        model_checksum=str(model.header["checksum"]),
        body=parameters,
        camera=CAMERA,
        light=LIGHT,
        reflectance=Reflectance(
            albedo=luminance,
            specularity=np.full(len(luminance), GLOSS),
            ambient=AMBIENT,
            specular_exponent=EXPONENT,
        ),
        albedo_rgb=paint,
    )
    return Sitter(
        person=person,
        evaluator=body.evaluator,
        paint=paint,
        even=photographed(paint),
        lit=photographed(shaded),
    )


@pytest.fixture(scope="module")
def texture(sitter) -> Texture:
    return picture_texture(sitter.person, sitter.evaluator, sitter.even, size=512)


def error(sitter, texture, origin):
    """Linear differences of a texture's texels of one origin from the paint."""
    model = sitter.evaluator.model
    atlas = atlas_of(model, len(texture.levels))
    corners = model.triangles[atlas.triangles]
    true = (sitter.paint[corners] * atlas.weights[..., None]).sum(axis=1)
    found = texture.scale * linear_from_display(texture.levels[atlas.inside] / 255.0)
    chosen = texture.coverage[atlas.inside] == origin
    assert chosen.any()
    return np.abs(found - true)[chosen]


def test_texels_lie_where_the_models_texture_coordinates_say(sitter):
    model = sitter.evaluator.model
    atlas = atlas_of(model, 512)
    corners = model.uv[model.uv_triangles[atlas.triangles]]
    u, v = (corners * atlas.weights[..., None]).sum(axis=1).T
    rows, columns = np.nonzero(atlas.inside)
    np.testing.assert_allclose(512.0 * u, columns + 0.5, atol=1e-3)
    np.testing.assert_allclose(512.0 * (1.0 - v), rows + 0.5, atol=1e-3)
    assert atlas.inside.mean() == pytest.approx(0.60, abs=0.01)


def test_islands_are_drawn_on_into_their_margin_and_no_farther(sitter):
    atlas = atlas_of(sitter.evaluator.model, 512)
    picture = drawn_on(atlas.inside, np.full(len(atlas.triangles), 200, dtype=np.uint8))
    away = cv2.distanceTransform((~atlas.inside).astype(np.uint8), cv2.DIST_L2, 5)
    assert (picture[away <= 8.0] == 200).all()
    assert (picture[away > 8.0] == 0).all()


def test_what_the_picture_shows_comes_back_as_it_was_painted(sitter, texture):
    seen = error(sitter, texture, TexelOrigin.SEEN)
    assert np.median(seen) < 0.003
    # Green tells left from right, and where belief fades the other side has its share.
    assert np.percentile(seen[:, [0, 2]], 99) < 0.01


def test_nothing_of_the_background_gets_onto_the_body(sitter, texture):
    """The wall is 0.9 in every channel, far above all paint."""
    for origin in TexelOrigin:
        assert error(sitter, texture, origin).max() < 0.25


def test_a_body_seen_from_the_front_is_seen_by_a_third_and_invented_behind(sitter, texture):
    assert 0.25 < texture.seen_share < 0.45
    model = sitter.evaluator.model
    atlas = atlas_of(model, 512)
    normals = render(sitter.evaluator.vertices(sitter.person.body), model.triangles, CAMERA)
    behind = normals.vertex_normals[model.triangles[atlas.triangles]].mean(axis=1)[:, 2] > 0.3
    assert (texture.coverage[atlas.inside][behind] != TexelOrigin.SEEN).all()


def test_what_one_side_hides_is_taken_from_the_other(sitter):
    """Only the person's right half is in the mask, so that the left is mirrored from it."""
    mask = np.zeros((CAMERA.height, CAMERA.width), dtype=np.bool_)
    mask[:, :300] = True
    half = picture_texture(sitter.person, sitter.evaluator, sitter.even, mask=mask, size=512)
    assert half.mirrored_share == pytest.approx(half.seen_share, rel=0.2)
    mirrored = error(sitter, half, TexelOrigin.MIRRORED)
    # Red runs with the height alone; green tells the sides apart by 0.1, and here it must not.
    assert np.median(mirrored[:, 0]) < 0.005
    assert np.median(mirrored[:, 1]) == pytest.approx(0.1, abs=0.01)


def test_the_albedo_comes_back_from_under_the_light(sitter):
    albedo = albedo_texture(sitter.person, sitter.evaluator, sitter.lit, size=512)
    seen = error(sitter, albedo, TexelOrigin.SEEN)
    assert np.median(seen) < 0.01
    assert np.percentile(seen, 95) < 0.06
    painted = picture_texture(sitter.person, sitter.evaluator, sitter.lit, size=512)
    assert np.median(error(sitter, painted, TexelOrigin.SEEN)) > 5.0 * np.median(seen)


def test_a_large_picture_is_read_at_two_megapixels():
    picture = linear_picture(np.full((3000, 4000, 3), 188, dtype=np.uint8))
    assert picture.shape == (1224, 1632, 3)
    np.testing.assert_allclose(picture, linear_from_display(np.array(188 / 255)), atol=1e-6)


def test_vertices_alone_have_the_colours_that_were_painted(sitter):
    vertices, triangles = (
        sitter.evaluator.vertices(sitter.person.body),
        sitter.evaluator.model.triangles,
    )
    seen = render(vertices, triangles, CAMERA)
    display = display_from_linear(sitter.even)
    colours = picture_colours(sitter.person, sitter.evaluator, display, seen.silhouette)
    away = np.abs(colours - sitter.paint).max(axis=1)
    # A fifth is seen squarely; the rest is like what was painted there on the other side.
    assert np.quantile(away, 0.2) < 0.003
    assert np.quantile(away, 0.9) < 0.04


def test_a_body_out_of_the_picture_has_no_texture(sitter):
    aside = replace(sitter.person.body, translation=np.array([9.0, 0.0, 2.9]))
    with pytest.raises(InvalidInputError, match="nothing of the fitted body"):
        picture_texture(replace(sitter.person, body=aside), sitter.evaluator, sitter.even)


@pytest.mark.parametrize("with_light", [False, True])
def test_the_file_holds_the_body_its_texture_and_its_light(sitter, texture, with_light):
    model = sitter.evaluator.model
    vertices = sitter.evaluator.vertices(sitter.person.body)
    picture = png(texture.levels)
    content = textured_glb(
        vertices,
        model,
        BodyTexture.of(model, picture, media_type="image/png", is_lit=not with_light),
        person=sitter.person,
        extras={"seen_share": texture.seen_share},
    )
    glb = read_glb(content)
    owners = glb.attribute("_VERTEX").astype(int)
    np.testing.assert_allclose(
        glb.attribute("POSITION"), (vertices * CAMERA_AXES)[owners], atol=1e-6
    )
    primitive = glb.document["meshes"][0]["primitives"][0]
    indices = glb.accessor(primitive["indices"]).reshape(-1, 3)
    np.testing.assert_array_equal(owners[indices], model.triangles)
    assert ("KHR_materials_unlit" in glb.document["extensionsUsed"]) is not with_light
    view = glb.document["bufferViews"][glb.document["images"][0]["bufferView"]]
    start = view["byteOffset"]
    assert glb.binary[start : start + view["byteLength"]] == picture
