"""A body without picture and camera as a glTF 2.0 binary file.

Metres, y up, the lowest vertex at y = 0; vertex order is the body model's.
"""

from collections.abc import Mapping

import numpy as np

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.export.body_texture import BodyTexture
from fitter.export.glb import BinaryChunk, pack_glb
from fitter.export.gltf_document import Frame, gltf_document
from fitter.export.gltf_mesh import BODY_NODE, add_body_mesh
from fitter.parameters import Reflectance


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
