"""A picture on a body's surface, in glTF.

A vertex where the skin is cut for the atlas has several texels, and a vertex of a glTF file has
one: such vertices are repeated, behind all others, so that the order of those is the body model's.
``_VERTEX`` names the vertex of the model that each of the file's is.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles
from fitter.body.model import BodyModel
from fitter.export.glb import BinaryChunk

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
