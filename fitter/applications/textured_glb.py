"""A textured body as a glTF 2.0 binary file, before the camera of its fit."""

from collections.abc import Mapping

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.export.body_texture import BodyTexture
from fitter.export.glb import BinaryChunk, pack_glb
from fitter.export.gltf_mesh import add_body_mesh
from fitter.export.gltf_scene import pictured_document
from fitter.person.fitted_person import FittedPerson


def textured_glb(
    vertices: Vertices,
    model: BodyModel,
    picture: bytes,
    *,
    person: FittedPerson,
    media_type: str = "image/png",
    colour_scale: float = 1.0,
    is_albedo: bool = False,
    extras: Mapping[str, object],
) -> bytes:
    """The body with a picture on its skin, before the camera of its fit.

    Parameters
    ----------
    vertices
        (m, 3) where the person stands, metres, in the camera's axes with y up.
    model
        Whose triangles and atlas.
    person
        Whose camera the file gets and, for an albedo texture, whose light.
    picture, media_type
        The texture, PNG or JPEG, its rows from the top of the atlas.
    colour_scale
        Linear values are the texture's times this.
    is_albedo
        A texture without light, to be lit; one that has its light painted in is shown as it is.
    extras
        What else is said of it; JSON values.
    """
    document = pictured_document(
        person,
        model,
        in_file_axes(vertices),
        name="body_textured",
        colour_scale=colour_scale if is_albedo else None,
        extras=extras,
    )
    binary = BinaryChunk()
    add_body_mesh(
        document,
        binary,
        vertices=vertices,
        triangles=model.triangles,
        reflectance=None,
        albedo_rgb=None,
        texture=BodyTexture.of(model, picture, media_type=media_type, is_lit=not is_albedo),
    )
    return pack_glb(document, binary)


def in_file_axes(vertices: Vertices) -> Vertices:
    """From the camera frame to glTF's axes, and back."""
    return vertices * CAMERA_AXES
