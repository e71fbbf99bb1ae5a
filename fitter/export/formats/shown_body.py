"""A body's surface and its looks, of which all other formats are written."""

import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Integer
from scipy.spatial.transform import Rotation

from fitter.arrays import Normals, Triangles, Vector3, Vertices
from fitter.export.gltf_mesh import unit_normals

_HEADER_BYTES = 12
_CHUNK_HEADER_BYTES = 8
_COMPONENT_TYPES = {5126: np.dtype("<f4"), 5123: np.dtype("<u2"), 5125: np.dtype("<u4")}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass(frozen=True, slots=True, eq=False)
class GlbFile:
    """The JSON of a file and its binary chunk."""

    document: dict[str, Any]
    binary: memoryview

    def array(self, accessor: int) -> np.ndarray:
        """(k, d) values of an accessor, (k, 1) where they are single numbers."""
        described = self.document["accessors"][accessor]
        columns = _COLUMNS[described["type"]]
        content = self.view(described["bufferView"])
        values = np.frombuffer(content, dtype=_COMPONENT_TYPES[described["componentType"]])
        return values[: described["count"] * columns].reshape(-1, columns)

    def view(self, index: int) -> memoryview:
        """The bytes of a buffer view."""
        described = self.document["bufferViews"][index]
        start = described.get("byteOffset", 0)
        return self.binary[start : start + described["byteLength"]]


def read_glb(content: bytes) -> GlbFile:
    """Read a file of one JSON chunk and one binary chunk."""
    (text_bytes,) = struct.unpack_from("<I", content, _HEADER_BYTES)
    text = _HEADER_BYTES + _CHUNK_HEADER_BYTES
    binary = text + text_bytes + _CHUNK_HEADER_BYTES
    document = json.loads(content[text : text + text_bytes])
    return GlbFile(document, memoryview(content)[binary:])


WHITE = (1.0, 1.0, 1.0, 1.0)
"""glTF's own base colour where a material names none."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Texture:
    """A picture on a surface.

    Attributes
    ----------
    picture, media_type
        The encoded picture, its rows from the top.
    texels
        (u, 2) places in it from 0 to 1, from the left and from the bottom.
    triangles
        (f, 3) which texel each corner of the body's triangles shows.
    """

    picture: bytes
    media_type: str
    texels: Float[np.ndarray, "u 2"]
    triangles: Triangles

    @property
    def name(self) -> str:
        """Name of the picture as a file beside others."""
        return {"image/png": "texture.png", "image/jpeg": "texture.jpg"}[self.media_type]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShownBody:
    """A body in the order of its model.

    Attributes
    ----------
    name
        Of the scene it is from.
    generator
        The program that made it, and its version.
    vertices, normals
        (m, 3) metres, y up.
    triangles
        (f, 3).
    colours
        (m, 3) linear red, green and blue, None where the body has one colour or a texture.
    colour
        The one colour, or the mean of all; linear.
    roughness
        As glTF has it.
    texture
        If it has one.
    """

    name: str
    generator: str
    vertices: Vertices
    normals: Normals
    triangles: Triangles
    colours: Float[np.ndarray, "m 3"] | None
    colour: Vector3
    roughness: float
    texture: Texture | None


def shown_body(glb: bytes) -> ShownBody:
    """Read one of the service's GLB files, which have one body each."""
    file = read_glb(glb)
    document = file.document
    primitive = document["meshes"][0]["primitives"][0]
    attributes = primitive["attributes"]
    corners = file.array(primitive["indices"]).reshape(-1, 3).astype(np.int64)
    vertices = _standing_vertices(file)
    owners = np.arange(len(vertices))
    if "_VERTEX" in attributes:
        owners = file.array(attributes["_VERTEX"])[:, 0].astype(np.int64)
        vertices = _in_model_order(vertices, owners)
    triangles = owners[corners]
    material = document["materials"][primitive["material"]]["pbrMetallicRoughness"]
    colours = None
    base = np.array(material.get("baseColorFactor", WHITE)[:3])
    if "COLOR_0" in attributes:
        colours = base * file.array(attributes["COLOR_0"]).astype(np.float64)
    return ShownBody(
        name=document["scenes"][document.get("scene", 0)]["name"],
        generator=document["asset"]["generator"],
        vertices=vertices,
        normals=unit_normals(vertices, triangles),
        triangles=triangles,
        colours=colours,
        colour=base if colours is None else colours.mean(axis=0),
        roughness=float(material["roughnessFactor"]),
        texture=_texture(file, material, attributes, corners),
    )


def _in_model_order(
    vertices: Float[np.ndarray, "u 3"], owners: Integer[np.ndarray, " u"]
) -> Vertices:
    """Each vertex of the body once, of those a texture's seams made of it."""
    ordered = np.zeros((owners.max() + 1, 3))
    ordered[owners] = vertices
    return ordered


def _texture(
    file: GlbFile,
    material: dict[str, Any],
    attributes: dict[str, int],
    corners: Triangles,
) -> Texture | None:
    if "baseColorTexture" not in material:
        return None
    document = file.document
    source = document["textures"][material["baseColorTexture"]["index"]]["source"]
    image = document["images"][source]
    # glTF counts texels from the top, all the other formats from the bottom.
    from_top = file.array(attributes["TEXCOORD_0"]).astype(np.float64)
    return Texture(
        picture=bytes(file.view(image["bufferView"])),
        media_type=image["mimeType"],
        texels=np.column_stack([from_top[:, 0], 1.0 - from_top[:, 1]]),
        triangles=corners,
    )


def _standing_vertices(file: GlbFile) -> Vertices:
    """(m, 3) vertices of the file's one mesh in the axes of its scene, metres: nothing is animated.

    A node's place is its own in those of the nodes above it; bones move a skin. The nodes of an
    animated file stand as its first frame has them, and its morph targets weigh nothing there.
    """
    nodes = file.document["nodes"]
    node = next(each for each in range(len(nodes)) if "mesh" in nodes[each])
    attributes = file.document["meshes"][nodes[node]["mesh"]]["primitives"][0]["attributes"]
    vertices = file.array(attributes["POSITION"]).astype(np.float64)
    if "skin" in nodes[node]:
        return _skinned(file, nodes[node]["skin"], attributes, vertices)
    place = _place(nodes, node)
    return vertices @ place[:3, :3].T + place[:3, 3]


def _skinned(file: GlbFile, skin: int, attributes: dict[str, int], vertices: Vertices) -> Vertices:
    """Vertices moved by their bones; the mesh's own node has no say."""
    bound = file.document["skins"][skin]
    # Stored column after column.
    inverse_bind = file.array(bound["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    nodes = file.document["nodes"]
    motions = np.stack([_place(nodes, joint) for joint in bound["joints"]]) @ inverse_bind
    joints = file.array(attributes["JOINTS_0"])
    weights = file.array(attributes["WEIGHTS_0"]).astype(np.float64)
    matrices = np.einsum("mb,mbij->mij", weights, motions[joints][:, :, :3])
    return np.einsum("mij,mj->mi", matrices[:, :, :3], vertices) + matrices[:, :, 3]


def _place(nodes: list[dict[str, Any]], node: int) -> Float[np.ndarray, "4 4"]:
    """From a node's axes to the scene's."""
    place = _own_place(nodes[node])
    for parent, each in enumerate(nodes):
        if node in each.get("children", ()):
            return _place(nodes, parent) @ place
    return place


def _own_place(node: dict[str, Any]) -> Float[np.ndarray, "4 4"]:
    """From a node's axes to those of the node above it."""
    place = np.eye(4)
    if "rotation" in node:
        place[:3, :3] = Rotation.from_quat(node["rotation"]).as_matrix()
    place[:3, 3] = node.get("translation", 0.0)
    return place
