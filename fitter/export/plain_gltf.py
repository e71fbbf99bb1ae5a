"""A body without picture and camera as a glTF 2.0 binary file.

Body frame (y up, facing +z), metres, feet on y = 0; vertex order is the body model's.
"""

from collections.abc import Mapping

import numpy as np

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.export.glb import BinaryChunk, pack_glb
from fitter.export.gltf import add_body_mesh, generator_name
from fitter.parameters import Reflectance


def plain_glb(
    vertices: Vertices,
    model: BodyModel,
    *,
    name: str,
    extras: Mapping[str, object],
    reflectance: Reflectance | None = None,
    albedo_rgb: Vertices | None = None,
) -> bytes:
    """The mesh in the colours of its skin, a neutral one where they are not known.

    Parameters
    ----------
    vertices
        (m, 3) body frame, metres.
    model
        Whose triangles and provenance.
    name
        Of the scene.
    extras
        What else is said of the body, beside its provenance; JSON values.
    reflectance, albedo_rgb
        Per vertex.
    """
    standing = vertices - np.array([0.0, vertices[:, 1].min(), 0.0])
    document = plain_document(model, name=name, extras=extras)
    document["nodes"] = [{"mesh": 0, "name": "body"}]
    binary = BinaryChunk()
    add_body_mesh(
        document,
        binary,
        vertices=standing,
        triangles=model.triangles,
        reflectance=reflectance,
        albedo_rgb=albedo_rgb,
    )
    return pack_glb(document, binary)


def plain_document(
    model: BodyModel, *, name: str, extras: Mapping[str, object]
) -> dict[str, object]:
    """A glTF document with its provenance, whose scene is node 0; still without nodes and mesh.

    Parameters
    ----------
    model
        Whose provenance.
    name
        Of the scene.
    extras
        What else is said of the body; JSON values.
    """
    provenance = {
        "generator": generator_name(),
        "gender": model.gender,
        "frame": "metres, +y up",
        "body_model": {
            "checksum": str(model.header.get("checksum", "")),
            "sources": model.header.get("sources", ""),
            "licences": model.header.get("licences", ""),
        },
        **extras,
    }
    return {
        # Blender keeps the scene's extras but drops the asset's, so both carry them.
        "asset": {"version": "2.0", "generator": generator_name(), "extras": provenance},
        "scene": 0,
        "scenes": [{"name": name, "nodes": [0], "extras": provenance}],
    }
