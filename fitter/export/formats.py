"""The service's GLB files as OBJ, PLY and STL: bytes in, bytes out, the same for the same.

Vertices and triangles are the body model's, in its order, metres, y up, to a micrometre; an
animation is shown as it begins. OBJ is written directly: a vertex and what it shows of a texture
are counted apart, so that the seams of the texture leave the vertices alone; trimesh writes one
count for both. Colours per vertex are a widespread extension: red, green and blue as displayed,
after the coordinates.
"""

import json
import struct
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from jaxtyping import Float, Integer
from scipy.spatial.transform import Rotation

from fitter.arrays import Normals, Triangles, Vector3, Vertices
from fitter.export.display import to_levels
from fitter.export.gltf_mesh import unit_normals
from fitter.observation.pixels import display_from_linear

if TYPE_CHECKING:
    import trimesh

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


MATERIAL = "skin"


def obj_file(body: ShownBody) -> bytes:
    """The body as text; a textured one refers to its material file."""
    columns = body.vertices
    if body.colours is not None:
        columns = np.column_stack([columns, display_from_linear(body.colours)])
    parts = [f"# {body.generator}: metres, +y up, vertices in the body model's order\n"]
    if body.texture is not None:
        parts.append(f"mtllib {body.name}.mtl\n")
    parts += [f"o {body.name}\n", _rows("v", columns, places=6)]
    if body.texture is not None:
        parts.append(_rows("vt", body.texture.texels, places=6))
    parts.append(_rows("vn", body.normals, places=4))
    if body.texture is not None:
        parts.append(f"usemtl {MATERIAL}\n")
    # Smooth shading throughout.
    parts.append("s 1\n")
    parts += _faces(body.triangles, body.texture)
    return "".join(parts).encode()


def mtl_file(body: ShownBody, texture: Texture) -> bytes:
    """The material of a textured body; it refers to the texture's file by name.

    Kd multiplies the picture, so it is the base colour's factor, which is white.
    """
    colour = " ".join(f"{value:.6f}" for value in display_from_linear(body.colour))
    return (
        f"# {body.generator}\nnewmtl {MATERIAL}\nKd {colour}\nKs 0 0 0\nillum 1\n"
        f"map_Kd {texture.name}\n"
    ).encode()


def _rows(keyword: str, values: Float[np.ndarray, "k d"], *, places: int) -> str:
    row = keyword + f" %.{places}f" * values.shape[1] + "\n"
    # Adding zero leaves no negative zeros.
    return (row * len(values)) % tuple((values.round(places) + 0.0).ravel().tolist())


def _faces(triangles: Integer[np.ndarray, "f 3"], texture: Texture | None) -> Iterator[str]:
    """Corners as vertex/texel/normal, counted from one; a vertex and its normal share a number."""
    vertices = triangles + 1
    if texture is None:
        numbers = np.stack([vertices, vertices], axis=2)
        row = "f %d//%d %d//%d %d//%d\n"
    else:
        numbers = np.stack([vertices, texture.triangles + 1, vertices], axis=2)
        row = "f %d/%d/%d %d/%d/%d %d/%d/%d\n"
    yield (row * len(triangles)) % tuple(numbers.ravel().tolist())


def ply_file(body: ShownBody) -> bytes:
    """Binary PLY with normals, and colours as displayed where each vertex has its own."""
    from trimesh.exchange.ply import export_ply

    return export_ply(_mesh(body), encoding="binary", vertex_normal=True)


def stl_file(body: ShownBody) -> bytes:
    """Binary STL: triangles in the model's order, each with its three corners; no colours."""
    from trimesh.exchange.stl import export_stl

    return export_stl(_mesh(body))


def _mesh(body: ShownBody) -> "trimesh.Trimesh":
    # It brings a hundred modules, and is loaded by whom one of its formats is asked of.
    import trimesh

    levels = None
    if body.colours is not None:
        levels = to_levels(display_from_linear(body.colours))
        levels = np.column_stack([levels, np.full(len(levels), 255, dtype=np.uint8)])
    # Processing would merge and reorder vertices.
    return trimesh.Trimesh(
        vertices=body.vertices,
        faces=body.triangles,
        vertex_normals=body.normals,
        vertex_colors=levels,
        process=False,
    )


class UntexturedError(Exception):
    """A material file was asked for of a body without a texture."""


def converted(glb: bytes, ending: str) -> bytes:
    """The body of a GLB file in the format of an ending of :data:`FORMATS`.

    Raises
    ------
    UntexturedError
        If it is ``mtl`` and the body has no texture.
    """
    return FORMATS[ending](shown_body(glb))


def _mtl(body: ShownBody) -> bytes:
    if body.texture is None:
        raise UntexturedError
    return mtl_file(body, body.texture)


FORMATS: Final[Mapping[str, Callable[[ShownBody], bytes]]] = {
    "obj": obj_file,
    "mtl": _mtl,
    "ply": ply_file,
    "stl": stl_file,
}
"""By the ending of a file's name; ``mtl`` is the material file of a textured OBJ."""
