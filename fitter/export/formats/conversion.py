"""From a GLB file of the service to the same body in another format.

Written directly: a vertex and what it shows of a texture are counted apart, so that the seams of
the texture leave the vertices alone; trimesh writes one count for both. Coordinates are given to a
micrometre. Colours per vertex are a widespread extension: red, green and blue as displayed, after
the coordinates.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Final

import numpy as np
import trimesh
from jaxtyping import Float, Integer
from trimesh.exchange.ply import export_ply
from trimesh.exchange.stl import export_stl

from fitter.export.display import to_levels
from fitter.export.formats.shown_body import ShownBody, Texture, shown_body
from fitter.observation.pixels import display_from_linear

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
    return export_ply(_mesh(body), encoding="binary", vertex_normal=True)


def stl_file(body: ShownBody) -> bytes:
    """Binary STL: triangles in the model's order, each with its three corners; no colours."""
    return export_stl(_mesh(body))


def _mesh(body: ShownBody) -> trimesh.Trimesh:
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


def _ply(body: ShownBody) -> bytes:
    # Trimesh brings a hundred modules, and is loaded by whom one of its formats is asked of.
    from fitter.export.formats.conversion import ply_file

    return ply_file(body)


def _stl(body: ShownBody) -> bytes:
    from fitter.export.formats.conversion import stl_file

    return stl_file(body)


FORMATS: Final[Mapping[str, Callable[[ShownBody], bytes]]] = {
    "obj": obj_file,
    "mtl": _mtl,
    "ply": _ply,
    "stl": _stl,
}
"""By the ending of a file's name; ``mtl`` is the material file of a textured OBJ."""
