"""One z-buffer rendering of a mesh: what every image energy of a candidate body reads."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import GreyImage, Mask, Normals, PerVertex, Triangles, Vertices
from fitter.render import _kernels
from fitter.render.camera import Camera

NEAR_PLANE_M = 0.05
"""Triangles with a corner nearer than this are dropped: nobody is photographed from 5 cm."""

LEAST_AREA_PX = 1e-9
"""Twice the area under which a triangle's depth gradient is numerically meaningless."""

DEPTH_TOLERANCE_M = 0.005
"""Largest depth of a surface point behind the z-buffer at which it still counts as seen: depth is
held at pixel centres, and a surface turned 60 degrees away sinks 4 mm within the half pixel (2 to
3 mm at usual scales) between a vertex and the next centre."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Rendering:
    """A mesh seen by a camera; all in the camera frame, metres.

    What only some energies read is computed when it is first asked for.

    Attributes
    ----------
    face_ids
        (h, w) the triangle seen through each pixel's centre, -1 for none.
    inverse_depth
        (h, w) its 1/z, 0 for none.
    projected
        (m, 2) vertices in continuous pixels; meaningless (the picture's centre) for vertices at
        or before the near plane.
    front_facing
        (f,) whether a triangle turns its outer side to the camera and lies beyond the near plane.
    """

    vertices: Vertices
    triangles: Triangles
    camera: Camera
    face_ids: Integer[np.ndarray, "h w"]
    inverse_depth: GreyImage
    projected: Float[np.ndarray, "m 2"]
    front_facing: Bool[np.ndarray, " f"]

    @property
    def silhouette(self) -> Mask:
        """(h, w) the pixels whose centre the mesh covers."""
        return self.face_ids >= 0

    @property
    def depth(self) -> GreyImage:
        """(h, w) z of what each pixel's centre sees, infinite for nothing."""
        with np.errstate(divide="ignore"):
            return np.float32(1.0) / self.inverse_depth

    @property
    def triangle_normals(self) -> Float[np.ndarray, "f 3"]:
        """(f, 3) outward unit normals."""
        return self._normals[0]

    @property
    def vertex_normals(self) -> Normals:
        """(m, 3) outward unit normals, area-weighted means of those of the triangles."""
        return self._normals[1]

    @cached_property
    def vertex_visible(self) -> Bool[np.ndarray, " m"]:
        """(m,) whether the vertex lies in the picture, faces the camera and is not occluded."""
        return _kernels.visible_vertices(
            self.vertices,
            self.vertex_normals,
            self.projected,
            self.inverse_depth,
            NEAR_PLANE_M,
            DEPTH_TOLERANCE_M,
        )

    @cached_property
    def _normals(self) -> tuple[Float[np.ndarray, "f 3"], Normals]:
        return _kernels.mesh_normals(self.vertices, self.triangles)


def render(vertices: Vertices, triangles: Triangles, camera: Camera) -> Rendering:
    """Render a closed mesh, given in the camera frame.

    Only front faces are drawn: from outside a closed surface the nearest hit is always one, so
    nothing changes but the time. A mesh that reaches behind the near plane is seen open there.
    """
    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    triangles = np.ascontiguousarray(triangles, dtype=np.int32)
    projected, vertex_inverse_depth = _kernels.project_vertices(
        vertices, camera.focal_length_px, camera.centre_x, camera.centre_y, NEAR_PLANE_M
    )
    face_ids, inverse_depth, front_facing = _kernels.rasterise(
        projected, vertex_inverse_depth, triangles, camera.width, camera.height, LEAST_AREA_PX
    )
    return Rendering(
        vertices=vertices,
        triangles=triangles,
        camera=camera,
        face_ids=face_ids,
        inverse_depth=inverse_depth,
        projected=projected,
        front_facing=front_facing,
    )


def shade_image(
    rendering: Rendering, values_per_vertex: PerVertex, *, background: float = 0.0
) -> GreyImage:
    """(h, w) float32 picture of (m,) values, interpolated linearly over each visible triangle."""
    return _kernels.interpolate(
        rendering.face_ids,
        rendering.triangles,
        rendering.projected,
        np.ascontiguousarray(rendering.vertices[:, 2]),
        np.ascontiguousarray(values_per_vertex, dtype=np.float64),
        background,
    )
