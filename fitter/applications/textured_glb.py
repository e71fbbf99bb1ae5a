"""A textured body as a glTF 2.0 binary file.

Vertices are those of the atlas: where the skin is cut for it, one vertex of the body is two of the
file's. ``_VERTEX`` gives each its id in the body model.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Integer

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.export.glb import BinaryChunk, Target, pack_glb
from fitter.export.gltf_camera import CAMERA_NODE, camera_description
from fitter.export.gltf_document import Node, gltf_document
from fitter.export.gltf_light import PUNCTUAL, light_and_node
from fitter.export.gltf_mesh import BODY_NODE, NEUTRAL_ROUGHNESS, unit_normals
from fitter.export.gltf_upright import set_upright
from fitter.person.fitted_person import FittedPerson

UNLIT = "KHR_materials_unlit"


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
    nodes: list[Node] = [BODY_NODE, CAMERA_NODE]
    extensions: dict[str, object] = {}
    used: list[str] = []
    if not is_albedo:
        material["extensions"] = {UNLIT: {}}
        used = [UNLIT]
    elif person.light is not None and person.reflectance is not None:
        light, node = light_and_node(
            person.light,
            body_centre=person.body.translation,
            colour_scale=colour_scale,
            reflectance=person.reflectance,
        )
        nodes.append(node)
        extensions = {PUNCTUAL: {"lights": [light]}}
        used = [PUNCTUAL]
    nodes, frame = set_upright(nodes, person, in_file_axes(vertices))
    document = gltf_document(nodes, model, name="body_textured", frame=frame, extras=extras) | {
        "cameras": [camera_description(person.camera)],
        "meshes": [{"name": "body", "primitives": [primitive]}],
        "materials": [material],
        "textures": [{"source": 0, "sampler": 0}],
        # Trilinear, and clamped: islands' margins never reach round the atlas.
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}],
        "images": [{"bufferView": binary.add_file(picture), "mimeType": media_type}],
    }
    if extensions:
        document["extensions"] = extensions
    if used:
        document["extensionsUsed"] = used
    return pack_glb(document, binary)


def owners_of_texels(model: BodyModel) -> Integer[np.ndarray, " u"]:
    """The body's vertex at each of the atlas' vertices."""
    owners = np.zeros(len(model.uv), dtype=np.int64)
    owners[model.uv_triangles.ravel()] = model.triangles.ravel()
    return owners


def in_file_axes(vertices: Vertices) -> Vertices:
    """From the camera frame to glTF's axes, and back."""
    return vertices * CAMERA_AXES
