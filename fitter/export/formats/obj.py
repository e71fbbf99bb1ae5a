"""Wavefront OBJ, and the material file beside a textured one.

Written directly: a vertex and what it shows of a texture are counted apart, so that the seams of
the texture leave the vertices alone; trimesh writes one count for both. Coordinates are given to a
micrometre. Colours per vertex are a widespread extension: red, green and blue as displayed, after
the coordinates.
"""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float, Integer

from fitter.export.formats.shown_body import ShownBody, Texture
from fitter.observation.colour import display_from_linear

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
