"""GLB files of known bodies, and what every other format of them has to hold."""

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np

from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.export.display import png
from fitter.export.glb import Frame
from fitter.export.gltf import body_posed_glb, plain_glb, textured_glb
from fitter.export.gltf_mesh import BodyTexture
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.vocabulary.choices import Gender
from tests.unit.applications.bodies import packaged
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.results import CAMERA, result_of

MICROMETRE = 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class Known:
    """A file and the body in it: vertices in metres, in the model's order; linear colours."""

    glb: bytes
    vertices: np.ndarray
    triangles: np.ndarray
    colours: np.ndarray | None = None
    texels: np.ndarray | None = None
    texel_triangles: np.ndarray | None = None
    picture: bytes = b""


@cache
def coloured() -> Known:
    """A body before the camera, each vertex in its own colour."""
    model = bar_model()
    colours = np.random.default_rng(3).uniform(0.05, 0.6, (len(model.mean_vertices), 3))
    result = result_of(model, albedo_rgb=colours)
    return Known(
        glb=body_posed_glb(result.found, model),
        vertices=result.found.posed_vertices * CAMERA_AXES,
        triangles=model.triangles,
        colours=colours,
    )


@cache
def plain() -> Known:
    """A body on the ground, in one colour."""
    model = bar_model()
    lowest = model.mean_vertices[:, 1].min()
    return Known(
        glb=plain_glb(model.mean_vertices, model, name="body", frame=Frame.STANDING, extras={}),
        vertices=model.mean_vertices - [0.0, lowest, 0.0],
        triangles=model.triangles,
    )


@cache
def textured() -> Known:
    """A packaged body with a picture, which splits its vertices along seams."""
    model = packaged("female").model
    levels = np.random.default_rng(5).integers(0, 256, (16, 16, 3)).astype(np.uint8)
    picture = png(cv2.resize(levels, (64, 64)))
    texture = BodyTexture.of(model, picture, media_type="image/png", is_lit=True)
    return Known(
        glb=textured_glb(
            model.mean_vertices * CAMERA_AXES, model, texture, person=_person(model), extras={}
        ),
        vertices=model.mean_vertices,
        triangles=model.triangles,
        texels=model.uv,
        texel_triangles=model.uv_triangles,
        picture=picture,
    )


def _person(model: BodyModel) -> FittedPerson:
    """The mean person, 3 m before the camera of a picture without shading."""
    return FittedPerson(
        gender=Gender.FEMALE,
        model_checksum="",
        body=BodyParameters(
            pose=np.zeros((len(model.part_names), 3)),
            translation=np.array([0.0, 0.0, 3.0]),
            shape=np.zeros(len(model.shape_basis)),
        ),
        camera=CAMERA,
        light=None,
        reflectance=None,
        albedo_rgb=None,
    )


KNOWN = {"coloured": coloured, "plain": plain, "textured": textured}
