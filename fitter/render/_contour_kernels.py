"""Compiled search for the contour generator."""

from math import sqrt
from typing import no_type_check

import numpy as np
from numba import njit

from fitter.render._kernels import unoccluded


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def contour_edge_ids(edge_triangles, front_facing, edges, depths, near):
    """Ids of the edges with one triangle facing the camera and one facing away."""
    found = np.empty(edge_triangles.shape[0], dtype=np.int32)
    count = 0
    for e in range(edge_triangles.shape[0]):
        if (
            front_facing[edge_triangles[e, 0]] != front_facing[edge_triangles[e, 1]]
            and depths[edges[e, 0]] > near
            and depths[edges[e, 1]] > near
        ):
            found[count] = e
            count += 1
    return found[:count].copy()


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def describe_contour_edges(
    edge_ids,
    edges,
    edge_triangles,
    front_facing,
    vertices,
    triangles,
    projected,
    face_ids,
    inverse_depth,
    tolerance,
    beyond_rim,
):
    """Directed vertex ids, image endpoints, outward normals, visible, outer; one row per edge."""
    count = edge_ids.shape[0]
    height, width = inverse_depth.shape
    directed = np.empty((count, 2), dtype=np.int32)
    endpoints = np.empty((count, 2, 2))
    outward = np.empty((count, 2))
    visible = np.empty(count, dtype=np.bool_)
    outer = np.empty(count, dtype=np.bool_)
    for k in range(count):
        e = edge_ids[k]
        front, back = edge_triangles[e, 0], edge_triangles[e, 1]
        start, end = edges[e, 0], edges[e, 1]
        if not front_facing[front]:
            front, back = back, front
            start, end = end, start
        directed[k, 0] = start
        directed[k, 1] = end
        x0, y0 = projected[start, 0], projected[start, 1]
        x1, y1 = projected[end, 0], projected[end, 1]
        endpoints[k, 0, 0] = x0
        endpoints[k, 0, 1] = y0
        endpoints[k, 1, 0] = x1
        endpoints[k, 1, 1] = y1
        dx, dy = x1 - x0, y1 - y0
        length = sqrt(dx * dx + dy * dy)
        scale = 1.0 / length if length > 0.0 else 0.0
        # A front face runs clockwise around its inside in the image's axes (y down), so
        # the outside lies along (-dy, dx).
        nx, ny = -dy * scale, dx * scale
        outward[k, 0] = nx
        outward[k, 1] = ny

        # The back face must fall away behind the front one's plane; at a dent it is in front
        # and hides the edge itself, whatever the z-buffer's grain says.
        rise = 0.0
        a, b, c = triangles[front, 0], triangles[front, 1], triangles[front, 2]
        for axis in range(3):
            after, last = (axis + 1) % 3, (axis + 2) % 3
            normal = (vertices[b, after] - vertices[a, after]) * (
                vertices[c, last] - vertices[a, last]
            ) - (vertices[b, last] - vertices[a, last]) * (vertices[c, after] - vertices[a, after])
            for corner in range(3):
                v = triangles[back, corner]
                rise += normal * (vertices[v, axis] - vertices[start, axis])
        x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
        z = 0.5 * (vertices[start, 2] + vertices[end, 2])
        visible[k] = rise < 0.0 and unoccluded(x, y, z, inverse_depth, tolerance)
        column = int(np.floor(x + beyond_rim * nx))
        row = int(np.floor(y + beyond_rim * ny))
        in_picture = 0 <= column < width and 0 <= row < height
        outer[k] = visible[k] and (not in_picture or face_ids[row, column] < 0)
    return directed, endpoints, outward, visible, outer
