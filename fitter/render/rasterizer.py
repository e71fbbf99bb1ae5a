"""One z-buffer rendering of a mesh: what every image energy of a candidate body reads."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import GreyImage, Mask, Normals, Triangles, Vertices
from fitter.camera import Camera
from fitter.render import _kernels

NEAR_PLANE_M = 0.05
"""Triangles with a corner nearer than this are dropped: nobody is photographed from 5 cm."""

LEAST_AREA_PX = 1e-9
"""Twice the area under which a triangle's depth gradient is numerically meaningless."""

DEPTH_TOLERANCE_M = 0.005
"""How far behind the z-buffer a point of the surface may seem to lie and still be seen: depth is
held at pixel centres, and a surface turned 60 degrees away sinks 4 mm within the half pixel (2 to
3 mm at usual scales) between a vertex and the next centre."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rendering:
    """A mesh seen by a camera; all in the camera frame, metres.

    Attributes
    ----------
    face_ids
        (h, w) the triangle seen through each pixel's centre, -1 for none.
    depth
        (h, w) its z, infinite for none.
    projected
        (m, 2) vertices in continuous pixels; meaningless (the picture's centre) for vertices at
        or before the near plane.
    front_facing
        (f,) whether a triangle turns its outer side to the camera and lies beyond the near plane.
    triangle_normals, vertex_normals
        (f, 3), (m, 3) outward unit normals; those of vertices are area-weighted means.
    vertex_visible
        (m,) whether the vertex lies in the picture, faces the camera and is not occluded.
    """

    vertices: Vertices
    triangles: Triangles
    camera: Camera
    face_ids: Integer[np.ndarray, "h w"]
    depth: GreyImage
    projected: Float[np.ndarray, "m 2"]
    front_facing: Bool[np.ndarray, " f"]
    triangle_normals: Float[np.ndarray, "f 3"]
    vertex_normals: Normals
    vertex_visible: Bool[np.ndarray, " m"]

    @property
    def silhouette(self) -> Mask:
        """(h, w) the pixels whose centre the mesh covers."""
        return self.face_ids >= 0


def render(vertices: Vertices, triangles: Triangles, camera: Camera) -> Rendering:
    """Render a closed mesh, given in the camera frame.

    Only front faces are drawn: from outside a closed surface the nearest hit is always one, so
    nothing changes but the time. A mesh that reaches behind the near plane is seen open there.
    """
    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    triangles = np.ascontiguousarray(triangles, dtype=np.int32)
    projected, inverse_depth = _kernels.project_vertices(
        vertices, camera.focal_length_px, camera.centre_x, camera.centre_y, NEAR_PLANE_M
    )
    triangle_normals, vertex_normals = _kernels.mesh_normals(vertices, triangles)
    face_ids, depth, front_facing = _kernels.rasterise(
        projected, inverse_depth, triangles, camera.width, camera.height, LEAST_AREA_PX
    )
    vertex_visible = _kernels.visible_vertices(
        vertices, vertex_normals, projected, inverse_depth, depth, DEPTH_TOLERANCE_M
    )
    return Rendering(
        vertices=vertices,
        triangles=triangles,
        camera=camera,
        face_ids=face_ids,
        depth=depth,
        projected=projected,
        front_facing=front_facing,
        triangle_normals=triangle_normals,
        vertex_normals=vertex_normals,
        vertex_visible=vertex_visible,
    )
