"""The fitted body as glTF 2.0 binary files.

``body_posed.glb`` lies in the camera frame with glTF's axes (OpenCV x diag(1, -1, -1): x right,
y up, looking along -z), metres, so that its camera node is the identity, under a node that sets all
of it upright (:mod:`fitter.export.gltf_scene`); it carries camera, light, and reflectance per
vertex. ``body_canonical.glb`` lies in the body frame (y up, facing +z) in the canonical pose with
its feet on y = 0. Vertex order is the body model's, in both.

Metres, y up, the lowest vertex at y = 0; vertex order is the body model's.
"""

from collections.abc import Mapping

import numpy as np

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.export.body_texture import BodyTexture
from fitter.export.glb import BinaryChunk, Frame, gltf_document, pack_glb
from fitter.export.gltf_mesh import BODY_NODE, add_body_mesh, colour_scale_of
from fitter.export.gltf_scene import pictured_document
from fitter.parameters import Reflectance
from fitter.result import FitResult, PictureFit


def plain_glb(
    vertices: Vertices,
    model: BodyModel,
    *,
    name: str,
    frame: Frame,
    extras: Mapping[str, object],
    reflectance: Reflectance | None = None,
    albedo_rgb: Vertices | None = None,
    texture: BodyTexture | None = None,
) -> bytes:
    """The mesh with its texture or in the colours of its skin, else in a neutral one.

    Parameters
    ----------
    vertices
        (m, 3) y up, metres.
    model
        Whose triangles and provenance.
    name
        Of the scene.
    frame
        What the axes are.
    extras
        What else is said of the body, beside its provenance; JSON values.
    reflectance, albedo_rgb
        Per vertex.
    texture
        Shown in their place.
    """
    standing = vertices - np.array([0.0, vertices[:, 1].min(), 0.0])
    document = gltf_document([BODY_NODE], model, name=name, frame=frame, extras=extras)
    binary = BinaryChunk()
    add_body_mesh(
        document,
        binary,
        vertices=standing,
        triangles=model.triangles,
        reflectance=reflectance,
        albedo_rgb=albedo_rgb,
        texture=texture,
    )
    return pack_glb(document, binary)


def body_posed_glb(found: PictureFit, model: BodyModel) -> bytes:
    """The posed body with its camera, light and reflectance."""
    person = found.person
    document = pictured_document(
        person,
        model,
        found.posed_vertices,
        name="body_posed",
        colour_scale=colour_scale_of(person.reflectance, person.albedo_rgb),
        extras=_provenance(found),
    )
    binary = BinaryChunk()
    add_body_mesh(
        document,
        binary,
        vertices=found.posed_vertices * CAMERA_AXES,
        triangles=model.triangles,
        reflectance=person.reflectance,
        albedo_rgb=person.albedo_rgb,
    )
    return pack_glb(document, binary)


def body_canonical_glb(result: FitResult, model: BodyModel) -> bytes:
    """The body in the canonical pose, standing on y = 0."""
    return plain_glb(
        result.canonical_vertices,
        model,
        name="body_canonical",
        frame=Frame.STANDING,
        extras=_provenance(result.found),
        reflectance=result.person.reflectance,
        albedo_rgb=result.person.albedo_rgb,
    )


def _provenance(found: PictureFit) -> dict[str, object]:
    """The fit that a file comes from."""
    return {
        "method": "Guan, Weiss, Balan, Black: Estimating Human Shape and Pose from a Single "
        "Image, ICCV 2009",
        "height_m": found.height_m,
        "cues": found.cues.value,
        "outcome": found.outcome.value,
    }
