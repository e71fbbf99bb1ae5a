"""A body without picture, camera or reflectance as a glTF 2.0 binary file.

Body frame (y up, facing +z), metres, feet on y = 0; vertex order is the body model's.
"""

from collections.abc import Mapping

import numpy as np

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.export.glb import BinaryChunk, Target, pack_glb
from fitter.export.gltf import NEUTRAL_ALBEDO, NEUTRAL_ROUGHNESS, generator_name, unit_normals


def plain_glb(
    vertices: Vertices, model: BodyModel, *, name: str, extras: Mapping[str, object]
) -> bytes:
    """The mesh in a neutral colour.

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
    """
    standing = vertices - np.array([0.0, vertices[:, 1].min(), 0.0])
    binary = BinaryChunk()
    normals = unit_normals(standing, model.triangles)
    attributes = {
        "POSITION": binary.add(
            standing.astype(np.float32), target=Target.VERTEX_ATTRIBUTE, bounds=True
        ),
        "NORMAL": binary.add(normals.astype(np.float32), target=Target.VERTEX_ATTRIBUTE),
    }
    index_type = np.uint16 if len(vertices) < np.iinfo(np.uint16).max else np.uint32
    indices = binary.add(model.triangles.ravel().astype(index_type), target=Target.TRIANGLE_INDICES)
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
    return pack_glb(
        {
            # Blender keeps the scene's extras but drops the asset's, so both carry them.
            "asset": {"version": "2.0", "generator": generator_name(), "extras": provenance},
            "scene": 0,
            "scenes": [{"name": name, "nodes": [0], "extras": provenance}],
            "nodes": [{"mesh": 0, "name": "body"}],
            "meshes": [
                {
                    "name": "body",
                    "primitives": [{"attributes": attributes, "indices": indices, "material": 0}],
                }
            ],
            "materials": [
                {
                    "name": "neutral",
                    "pbrMetallicRoughness": {
                        "baseColorFactor": [NEUTRAL_ALBEDO] * 3 + [1.0],
                        "metallicFactor": 0.0,
                        "roughnessFactor": NEUTRAL_ROUGHNESS,
                    },
                }
            ],
        },
        binary,
    )
