"""The model's edges in the picture (section 3.3): where its surface turns away from the camera."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.numerics.mesh_topology import MeshTopology
from fitter.render import _contour_kernels
from fitter.render.rasterizer import DEPTH_TOLERANCE_M, NEAR_PLANE_M, Rendering

BEYOND_RIM_PX = 1.5
"""How far outside an edge to look for what it borders on: past the pixel the rim itself may own."""


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
