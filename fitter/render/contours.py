"""The model's edges in the picture (section 3.3): where its surface turns away from the camera."""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import Mask
from fitter.numerics.meshes import MeshTopology
from fitter.render import _contour_kernels
from fitter.render.rasterizer import DEPTH_TOLERANCE_M, NEAR_PLANE_M, Rendering

BEYOND_RIM_PX = 1.5
"""Distance outside an edge to read its neighbour at: past the pixel the rim itself may own."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ModelEdges:
    """Mesh edges on the contour generator of one rendering.

    Attributes
    ----------
    edges
        (k, 2) vertex ids, directed as the triangle facing the camera runs them.
    endpoints
        (k, 2, 2) their projections, continuous pixels; may lie outside the picture.
    outward
        (k, 2) unit normals in the image, pointing out of the part of the body the edge bounds;
        zero for an edge seen end on.
    visible
        (k,) whether the edge's midpoint lies in the picture and nothing hides it.
    is_outer_silhouette
        (k,) whether a visible edge borders on the background, not on another part of the body.
    """

    edges: Integer[np.ndarray, "k 2"]
    endpoints: Float[np.ndarray, "k 2 2"]
    outward: Float[np.ndarray, "k 2"]
    visible: Bool[np.ndarray, " k"]
    is_outer_silhouette: Bool[np.ndarray, " k"]


def model_edges(rendering: Rendering, topology: MeshTopology) -> ModelEdges:
    """Edges whose two triangles turn different sides to the ray through the edge's midpoint.

    The midpoint lies in both triangles' planes, so the sign of normal . ray there is the sign
    anywhere on the triangle: the rasteriser's ``front_facing``. The paper tests every edge anew.
    """
    depths = rendering.vertices[:, 2]
    edge_ids = _contour_kernels.contour_edge_ids(
        topology.edge_triangles, rendering.front_facing, topology.edges, depths, NEAR_PLANE_M
    )
    directed, endpoints, outward, visible, outer = _contour_kernels.describe_contour_edges(
        edge_ids,
        topology.edges,
        topology.edge_triangles,
        rendering.front_facing,
        rendering.vertices,
        rendering.triangles,
        rendering.projected,
        rendering.face_ids,
        rendering.inverse_depth,
        DEPTH_TOLERANCE_M,
        BEYOND_RIM_PX,
    )
    return ModelEdges(
        edges=directed,
        endpoints=endpoints,
        outward=outward,
        visible=visible,
        is_outer_silhouette=outer,
    )


FLATTENED_PX = 0.6
"""Corners that stand out less than this from the line through their neighbours are left out."""


def outline_loops(silhouette: Mask) -> tuple[Float[np.ndarray, "_ 2"], ...]:
    """Closed lines round a silhouette and its holes, continuous pixels, longest first.

    They run through the centres of the silhouette's outermost pixels, so that they lie up to half a
    pixel inside it. Filled by the even-odd rule they are the silhouette.
    """
    found, _ = cv2.findContours(silhouette.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    flattened = [cv2.approxPolyDP(loop, FLATTENED_PX, True)[:, 0, :] for loop in found]
    # Three corners enclose something; fewer are specks of one pixel's width.
    loops = [loop.astype(np.float64) + 0.5 for loop in flattened if len(loop) >= 3]
    return tuple(sorted(loops, key=len, reverse=True))
