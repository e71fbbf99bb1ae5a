"""PLY and STL, written by trimesh."""

import numpy as np
import trimesh
from trimesh.exchange.ply import export_ply
from trimesh.exchange.stl import export_stl

from fitter.export.display import to_levels
from fitter.export.formats.shown_body import ShownBody
from fitter.observation.colour import display_from_linear


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
