"""What all the other formats are written from: a body's surface and how it looks."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Normals, Triangles, Vector3, Vertices
from fitter.export.formats.glb_file import GlbFile, read_glb
from fitter.export.formats.standing_vertices import standing_vertices
from fitter.export.gltf_mesh import unit_normals

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
        """Of the picture as a file beside others."""
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
    vertices = standing_vertices(file)
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
