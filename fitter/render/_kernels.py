"""Compiled loops of the rasteriser. Plain arrays in and out; the wrappers document them."""

from math import ceil, sqrt
from typing import no_type_check

import numpy as np
from numba import njit, uint32

# How far rounding may move the end of a row's span, in pixels.
ROUNDING = 1e-6


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def project_vertices(vertices, focal_length, centre_x, centre_y, near):
    """(m, 2) continuous pixels and (m,) 1/z; 1/z is 0 for vertices not beyond the near plane."""
    count = vertices.shape[0]
    projected = np.empty((count, 2))
    inverse_depth = np.empty(count)
    for i in range(count):
        z = vertices[i, 2]
        w = 1.0 / z if z > near else 0.0
        inverse_depth[i] = w
        projected[i, 0] = vertices[i, 0] * w * focal_length + centre_x
        projected[i, 1] = vertices[i, 1] * w * focal_length + centre_y
    return projected, inverse_depth


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def mesh_normals(vertices, triangles):
    """(f, 3) unit triangle normals and (m, 3) unit area-weighted vertex normals, 0 if undefined."""
    count = triangles.shape[0]
    triangle_normals = np.empty((count, 3))
    vertex_normals = np.zeros((vertices.shape[0], 3))
    for t in range(count):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ux = vertices[b, 0] - vertices[a, 0]
        uy = vertices[b, 1] - vertices[a, 1]
        uz = vertices[b, 2] - vertices[a, 2]
        vx = vertices[c, 0] - vertices[a, 0]
        vy = vertices[c, 1] - vertices[a, 1]
        vz = vertices[c, 2] - vertices[a, 2]
        nx = uy * vz - uz * vy
        ny = uz * vx - ux * vz
        nz = ux * vy - uy * vx
        for corner in (a, b, c):
            vertex_normals[corner, 0] += nx
            vertex_normals[corner, 1] += ny
            vertex_normals[corner, 2] += nz
        length = sqrt(nx * nx + ny * ny + nz * nz)
        scale = 1.0 / length if length > 0.0 else 0.0
        triangle_normals[t, 0] = nx * scale
        triangle_normals[t, 1] = ny * scale
        triangle_normals[t, 2] = nz * scale
    for i in range(vertices.shape[0]):
        nx, ny, nz = vertex_normals[i, 0], vertex_normals[i, 1], vertex_normals[i, 2]
        length = sqrt(nx * nx + ny * ny + nz * nz)
        scale = 1.0 / length if length > 0.0 else 0.0
        vertex_normals[i, 0] = nx * scale
        vertex_normals[i, 1] = ny * scale
        vertex_normals[i, 2] = nz * scale
    return triangle_normals, vertex_normals


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def rasterise(projected, inverse_depth, triangles, width, height, least_area):
    """Scan-convert the front faces, nearest first by 1/z.

    1/z is affine over a triangle in the image, so its interpolation is perspective-correct.
    Edges are evaluated from their upper to their lower end in every triangle that has them, so
    that two triangles sharing an edge meet on it without a gap or a pixel owned twice.
    """
    face_ids = np.full((height, width), -1, dtype=np.int32)
    nearest = np.zeros((height, width), dtype=np.float32)
    front_facing = np.zeros(triangles.shape[0], dtype=np.bool_)
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        wa, wb, wc = inverse_depth[a], inverse_depth[b], inverse_depth[c]
        if wa == 0.0 or wb == 0.0 or wc == 0.0:
            continue
        ax, ay = projected[a, 0], projected[a, 1]
        bx, by = projected[b, 0], projected[b, 1]
        cx, cy = projected[c, 0], projected[c, 1]
        # Twice the signed area; negative for front faces, because y runs down in the image.
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if area >= 0.0:
            continue
        front_facing[t] = True
        if area > -least_area:
            continue
        # Most triangles of a head or a hand contain no pixel centre: skip them before any division.
        first_row = max(ceil(min(ay, by, cy) - 0.5), 0)
        end_row = min(ceil(max(ay, by, cy) - 0.5), height)
        if first_row >= end_row:
            continue
        left, right = min(ax, bx, cx), max(ax, bx, cx)
        if right < 0.0 or left > width:
            continue
        if ceil(left - 0.5 - ROUNDING) >= ceil(right - 0.5 + ROUNDING):
            continue
        scale = 1.0 / area
        dw_dx = ((wb - wa) * (cy - ay) - (wc - wa) * (by - ay)) * scale
        dw_dy = ((wc - wa) * (bx - ax) - (wb - wa) * (cx - ax)) * scale
        w_origin = wa + dw_dx * (0.5 - ax) - dw_dy * ay
        if by < ay:
            ax, ay, bx, by = bx, by, ax, ay
        if cy < by:
            bx, by, cx, cy = cx, cy, bx, by
            if by < ay:
                ax, ay, bx, by = bx, by, ax, ay
        long_slope = (cx - ax) / (cy - ay)
        upper_slope = (bx - ax) / (by - ay) if by > ay else 0.0
        lower_slope = (cx - bx) / (cy - by) if cy > by else 0.0
        for row in range(first_row, end_row):
            y = row + 0.5
            one = ax + (y - ay) * long_slope
            # y < by, as a row belongs to an edge when its centre lies in [top, bottom).
            other = ax + (y - ay) * upper_slope if y < by else bx + (y - by) * lower_slope
            first = max(ceil(min(one, other) - 0.5), 0)
            end = min(ceil(max(one, other) - 0.5), width)
            w_row = w_origin + dw_dy * y
            for column in range(first, end):
                w = np.float32(w_row + dw_dx * column)
                # Unsigned indices spare numba's test for negative ones: 0.2 ms of 1.2.
                i, j = uint32(row), uint32(column)
                if w > nearest[i, j]:
                    nearest[i, j] = w
                    face_ids[i, j] = t
    return face_ids, nearest, front_facing


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True, inline="always")
def unoccluded(x, y, z, inverse_depth, tolerance):
    """Whether a point is no farther than the surface at any of the four pixel centres around it.

    Near a silhouette some of the four lie outside it, where the surface is farther or absent. This
    lets a point on the rim pass, although within a fraction of a pixel its own surface bulges
    toward the camera by more than any useful tolerance.
    """
    height, width = inverse_depth.shape
    if not (0.0 <= x < width and 0.0 <= y < height):
        return False
    column = int(np.floor(x - 0.5))
    row = int(np.floor(y - 0.5))
    for i in range(max(row, 0), min(row + 2, height)):
        for j in range(max(column, 0), min(column + 2, width)):
            # z <= 1 / w + tolerance; w is 0 where nothing is.
            if (z - tolerance) * inverse_depth[i, j] <= 1.0:
                return True
    return False


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def visible_vertices(vertices, vertex_normals, projected, inverse_depth, near, tolerance):
    """(m,) True where the vertex faces the camera and nothing lies in front of it."""
    visible = np.zeros(vertices.shape[0], dtype=np.bool_)
    for i in range(vertices.shape[0]):
        if vertices[i, 2] <= near:
            continue
        facing = (
            vertex_normals[i, 0] * vertices[i, 0]
            + vertex_normals[i, 1] * vertices[i, 1]
            + vertex_normals[i, 2] * vertices[i, 2]
        )
        if facing < 0.0:
            visible[i] = unoccluded(
                projected[i, 0], projected[i, 1], vertices[i, 2], inverse_depth, tolerance
            )
    return visible


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def interpolate(face_ids, triangles, projected, depths, values, background):
    """(h, w) perspective-correct barycentric interpolation at pixel centres."""
    height, width = face_ids.shape
    picture = np.full((height, width), background, dtype=np.float32)
    for row in range(height):
        y = row + 0.5
        for column in range(width):
            t = face_ids[row, column]
            if t < 0:
                continue
            x = column + 0.5
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            ax, ay = projected[a, 0] - x, projected[a, 1] - y
            bx, by = projected[b, 0] - x, projected[b, 1] - y
            cx, cy = projected[c, 0] - x, projected[c, 1] - y
            # Areas opposite each corner, each divided by that corner's depth.
            wa = (bx * cy - cx * by) / depths[a]
            wb = (cx * ay - ax * cy) / depths[b]
            wc = (ax * by - bx * ay) / depths[c]
            picture[row, column] = (wa * values[a] + wb * values[b] + wc * values[c]) / (
                wa + wb + wc
            )
    return picture
