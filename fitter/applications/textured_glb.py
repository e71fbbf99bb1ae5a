"""A textured body as a glTF 2.0 binary file.

Vertices are those of the atlas: where the skin is cut for it, one vertex of the body is two of the
file's. ``_VERTEX`` gives each its id in the body model.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Integer

from fitter.applications.fitted_person import FittedPerson
from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.export.glb import BinaryChunk, Target, pack_glb
from fitter.export.gltf import (
    NEUTRAL_ROUGHNESS,
    generator_name,
    light_and_node,
    model_provenance,
    unit_normals,
)


def textured_glb(
    vertices: Vertices,
    model: BodyModel,
    picture: bytes,
    *,
    media_type: str = "image/png",
    colour_scale: float = 1.0,
    is_albedo: bool = False,
    lit_as: FittedPerson | None = None,
    extras: Mapping[str, object],
) -> bytes:
    """The body with a picture on its skin.

    Parameters
    ----------
    vertices
        (m, 3) metres, y up: the axes of the file.
    model
        Whose triangles and atlas.
    picture, media_type
        The texture, PNG or JPEG, its rows from the top of the atlas.
    colour_scale
        Linear values are the texture's times this.
    is_albedo
        A texture without light, to be lit; one that has its light painted in is shown as it is.
    lit_as
        Whose light to put in the file for that, with the body where that person stands. Where there
        is none, whoever shows the file lights it.
    extras
        What else is said of it; JSON values.
    """
    binary = BinaryChunk()
    owners = owners_of_texels(model)
    texels = np.column_stack([model.uv[:, 0], 1.0 - model.uv[:, 1]])

    def attribute(values: np.ndarray, *, bounds: bool = False) -> int:
        return binary.add(values.astype(np.float32), target=Target.VERTEX_ATTRIBUTE, bounds=bounds)

    attributes = {
        "POSITION": attribute(vertices[owners], bounds=True),
        "NORMAL": attribute(unit_normals(vertices, model.triangles)[owners]),
        "TEXCOORD_0": attribute(texels),
        "_VERTEX": attribute(owners),
    }
    indices = model.uv_triangles.ravel().astype(np.uint16)
    primitive = {
        "attributes": attributes,
        "indices": binary.add(indices, target=Target.TRIANGLE_INDICES),
        "material": 0,
    }
    material: dict[str, Any] = {
        "name": "skin",
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0},
            "metallicFactor": 0.0,
            "roughnessFactor": NEUTRAL_ROUGHNESS,
        },
    }
    nodes: list[dict[str, object]] = [{"mesh": 0, "name": "body"}]
    document: dict[str, Any] = {}
    if not is_albedo:
        material["extensions"] = {"KHR_materials_unlit": {}}
        document["extensionsUsed"] = ["KHR_materials_unlit"]
    elif lit_as is not None and lit_as.light is not None and lit_as.reflectance is not None:
        light, node = light_and_node(
            lit_as.light,
            body_centre=lit_as.body.translation,
            colour_scale=colour_scale,
            reflectance=lit_as.reflectance,
        )
        nodes.append(node)
        document["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
        document["extensionsUsed"] = ["KHR_lights_punctual"]
    said = {
        "generator": generator_name(),
        "gender": model.gender,
        "frame": "metres, +y up",
        "body_model": model_provenance(model),
        **extras,
    }
    document |= {
        "asset": {"version": "2.0", "generator": generator_name(), "extras": said},
        "scene": 0,
        "scenes": [{"name": "body_textured", "nodes": list(range(len(nodes))), "extras": said}],
        "nodes": nodes,
        "meshes": [{"name": "body", "primitives": [primitive]}],
        "materials": [material],
        "textures": [{"source": 0, "sampler": 0}],
        # Trilinear, and clamped: islands' margins never reach round the atlas.
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}],
        "images": [{"bufferView": binary.add_file(picture), "mimeType": media_type}],
    }
    return pack_glb(document, binary)


def owners_of_texels(model: BodyModel) -> Integer[np.ndarray, " u"]:
    """The body's vertex at each of the atlas' vertices."""
    owners = np.zeros(len(model.uv), dtype=np.int64)
    owners[model.uv_triangles.ravel()] = model.triangles.ravel()
    return owners


def in_file_axes(vertices: Vertices) -> Vertices:
    """From the camera frame to glTF's axes."""
    return vertices * CAMERA_AXES
