"""The body's mesh in a glTF document: arrays, colours or a texture, the material nearest to Eq. 1.

A vertex where the skin is cut for the atlas has several texels, and a vertex of a glTF file has
one: such vertices are repeated, behind all others, so that the order of those is the body model's.
``_VERTEX`` names the vertex of the model that each of the file's is.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Normals, Triangles, Vertices
from fitter.body.model import BodyModel
from fitter.export.glb import BinaryChunk, Node, Target
from fitter.numerics.meshes import summed_cross_products
from fitter.parameters import Reflectance

UNLIT = "KHR_materials_unlit"

TEXTURED_ROUGHNESS = 0.8


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyTexture:
    """A texture of a body model's atlas.

    Attributes
    ----------
    picture, media_type
        PNG or JPEG, sRGB, its rows from the top of the atlas.
    is_lit
        Whether light is painted in, so that it is shown as it is; else it is the albedo.
    owners
        (u,) which vertex of the model each of the file's is; the first m are those of the model.
    texels
        (u, 2) where each lies in the picture, from the left and from the top, 0 to 1.
    triangles
        (f, 3) of the file's vertices.
    """

    picture: bytes
    media_type: str
    is_lit: bool
    owners: Integer[np.ndarray, " u"]
    texels: Float[np.ndarray, "u 2"]
    triangles: Triangles

    @classmethod
    def of(
        cls, model: BodyModel, picture: bytes, *, media_type: str, is_lit: bool
    ) -> "BodyTexture":
        """A picture on the surface of a model."""
        owner = np.zeros(len(model.uv), dtype=np.int64)
        owner[model.uv_triangles.ravel()] = model.triangles.ravel()
        first = np.unique(owner, return_index=True)[1]
        order = np.concatenate([first, np.setdiff1d(np.arange(len(owner)), first)])
        place = np.empty_like(order)
        place[order] = np.arange(len(order))
        return cls(
            picture=picture,
            media_type=media_type,
            is_lit=is_lit,
            owners=owner[order],
            texels=np.column_stack([model.uv[order, 0], 1.0 - model.uv[order, 1]]),
            triangles=place[model.uv_triangles],
        )

    def described(
        self, document: dict[str, Any], binary: BinaryChunk
    ) -> tuple[dict[str, Any], list[str]]:
        """Put the picture into a document; the material that shows it, and its extensions."""
        document["textures"] = [{"source": 0, "sampler": 0}]
        # Trilinear, and clamped: islands' margins never reach round the atlas.
        document["samplers"] = [
            {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}
        ]
        view = binary.add_file(self.picture)
        document["images"] = [{"bufferView": view, "mimeType": self.media_type}]
        material: dict[str, Any] = {
            "name": "skin",
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0},
                "metallicFactor": 0.0,
                "roughnessFactor": TEXTURED_ROUGHNESS,
            },
        }
        if not self.is_lit:
            return material, []
        return material | {"extensions": {UNLIT: {}}}, [UNLIT]


BODY_NODE: Node = {"mesh": 0, "name": "body"}

NEUTRAL_ALBEDO = 0.6
"""Base colour where no reflectance was estimated (SE)."""

NEUTRAL_ROUGHNESS = 0.8

DIELECTRIC_REFLECTANCE = 0.04
"""glTF's reflectance at normal incidence, which KHR_materials_specular scales."""

COLOUR_PERCENTILE = 99.0
"""Albedo is relative to a light of intensity 1, so that of skin may be 1 and more: it is known but
for a factor. In files this percentile of it is at most ``LIGHTEST``, and the light is made as much
stronger."""

LIGHTEST = 0.65
"""Linear reflectance that hardly any surface of a person exceeds (light skin has 0.4 to 0.6 in red,
white cloth 0.7 to 0.8): brighter colours are burnt out in the light of ordinary viewers."""


def add_body_mesh(
    document: dict[str, object],
    binary: BinaryChunk,
    *,
    vertices: Vertices,
    triangles: Triangles,
    reflectance: Reflectance | None,
    albedo_rgb: Vertices | None,
    texture: BodyTexture | None = None,
) -> dict[str, object]:
    """Give a document its one mesh, of the body, and its material.

    Parameters
    ----------
    document
        Gets ``meshes``, ``materials`` and ``extensionsUsed``.
    binary
        Gets the arrays.
    vertices, triangles
        The body, in the axes of the file.
    reflectance, albedo_rgb
        Per vertex; a neutral colour where there is none.
    texture
        Shown in place of reflectance and albedo, which the file then lacks.

    Returns
    -------
    dict
        The mesh's primitive as it stands in the document, to be added to.
    """

    def attribute(values: np.ndarray, *, bounds: bool = False) -> int:
        return binary.add(values.astype(np.float32), target=Target.VERTEX_ATTRIBUTE, bounds=bounds)

    positions, normals, scale = vertices, unit_normals(vertices, triangles), 1.0
    attributes: dict[str, int] = {}
    if texture is not None:
        positions, normals = vertices[texture.owners], normals[texture.owners]
        triangles = texture.triangles
        attributes["TEXCOORD_0"] = attribute(texture.texels)
        attributes["_VERTEX"] = attribute(texture.owners)
    elif reflectance is not None:
        scale = colour_scale_of(reflectance, albedo_rgb)
        colours = _colours(reflectance, albedo_rgb)
        attributes["COLOR_0"] = attribute(np.clip(colours / scale, 0.0, 1.0))
        attributes["_ALBEDO"] = attribute(reflectance.albedo)
        attributes["_SPECULARITY"] = attribute(reflectance.specularity)
    attributes["POSITION"] = attribute(positions, bounds=True)
    attributes["NORMAL"] = attribute(normals)
    index_type = np.uint16 if len(positions) < np.iinfo(np.uint16).max else np.uint32
    indices = binary.add(triangles.ravel().astype(index_type), target=Target.TRIANGLE_INDICES)
    if texture is None:
        material, extensions = _material(reflectance, scale)
    else:
        material, extensions = texture.described(document, binary)
    if "extensions" in document:
        extensions = ["KHR_lights_punctual", *extensions]
    if extensions:
        document["extensionsUsed"] = sorted(extensions)
    document["materials"] = [material]
    primitive: dict[str, object] = {"attributes": attributes, "indices": indices, "material": 0}
    document["meshes"] = [{"name": "body", "primitives": [primitive]}]
    return primitive


def unit_normals(vertices: Vertices, triangles: Triangles) -> Normals:
    """Area-weighted unit normals; +z where the triangles round a vertex have none."""
    sums = summed_cross_products(np.ascontiguousarray(vertices), triangles)
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.where(lengths > 0.0, sums / np.maximum(lengths, 1e-30), [0.0, 0.0, 1.0])


def _material(
    reflectance: Reflectance | None, colour_scale: float
) -> tuple[dict[str, object], list[str]]:
    """The nearest physically based material to Blinn-Phong, and the extensions it uses.

    Roughness = (2 / (α + 2))^(1/4) gives GGX the width of the lobe (h . n)^α. Its height at the
    mirror direction is F0 / (4 π roughness⁴) = F0 (α + 2) / (8 π); lit by π l it shall be s l, so
    F0 = 8 s / (α + 2), expressed as a multiple of glTF's dielectric 0.04.
    """
    if reflectance is None:
        return {
            "name": "neutral",
            "pbrMetallicRoughness": {
                "baseColorFactor": [NEUTRAL_ALBEDO] * 3 + [1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": NEUTRAL_ROUGHNESS,
            },
        }, []
    exponent = reflectance.specular_exponent
    mean_specularity = float(np.mean(reflectance.specularity)) / colour_scale
    factor = 8.0 * mean_specularity / (exponent + 2.0) / DIELECTRIC_REFLECTANCE
    return {
        "name": "skin",
        "pbrMetallicRoughness": {
            "metallicFactor": 0.0,
            "roughnessFactor": (2.0 / (exponent + 2.0)) ** 0.25,
        },
        "extensions": {"KHR_materials_specular": {"specularColorFactor": [factor] * 3}},
        "extras": {
            "specular_exponent": exponent,
            "ambient": reflectance.ambient,
            "mean_specularity": float(np.mean(reflectance.specularity)),
        },
    }, ["KHR_materials_specular"]


def _colours(reflectance: Reflectance, albedo_rgb: Vertices | None) -> Vertices:
    """Linear red, green and blue albedo per vertex; grey where only luminance was estimated."""
    if albedo_rgb is not None:
        return albedo_rgb
    return np.repeat(reflectance.albedo[:, None], 3, axis=1)


def colour_scale_of(reflectance: Reflectance | None, albedo_rgb: Vertices | None) -> float:
    """Scale by which the file's colours are divided and its light is multiplied."""
    if reflectance is None:
        return 1.0
    brightest = float(np.percentile(_colours(reflectance, albedo_rgb), COLOUR_PERCENTILE))
    return max(1.0, brightest / LIGHTEST)
