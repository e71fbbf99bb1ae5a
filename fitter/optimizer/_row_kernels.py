"""Compiled rows of the Gauss-Newton matrix: derivatives of residuals by all body parameters.

The Jacobian of points and directions by the linear-blend tangent (:mod:`fitter.body.tangent`)
contracted with each row's own derivative, without ever storing it. For a camera-frame derivative d
at a point x, with g = diag(1, -1, -1) d and y the point relative to the root in body axes, a turn
of joint j about an axis e of its parent changes the residual by

    e . ((y - c_j) × g), times how far the point follows joint j.

What these loops call is inlined by force: of a function that stays one, the process that compiles
it and one that loads it may run different machine code, which rounds otherwise.
"""

from math import sqrt
from typing import NamedTuple, no_type_check

import numpy as np
from numba import njit


class Points(NamedTuple):
    """Points (m, 3) in the camera frame, and how they follow joints, parts and shape."""

    positions: np.ndarray
    joint_follow: np.ndarray
    part_weights: np.ndarray
    shape_basis: np.ndarray


class Frame(NamedTuple):
    """The arrays of the :class:`~fitter.body.tangent.Linearisation` that rows are taken at."""

    translation: np.ndarray
    rotations: np.ndarray
    parent_rotations: np.ndarray
    joints: np.ndarray
    joint_offsets: np.ndarray


class Rest(NamedTuple):
    """Vertices (m, 3) of the body at rest, its triangles, and those around each vertex."""

    vertices: np.ndarray
    triangles: np.ndarray
    pointers: np.ndarray
    rings: np.ndarray


@no_type_check
@njit(cache=True, fastmath=True, forceinline=True)
def turned_back(rotations, j, gx, gy, gz):
    """A derivative in the axes of part j of the body at rest."""
    return (
        rotations[j, 0, 0] * gx + rotations[j, 1, 0] * gy + rotations[j, 2, 0] * gz,
        rotations[j, 0, 1] * gx + rotations[j, 1, 1] * gy + rotations[j, 2, 1] * gz,
        rotations[j, 0, 2] * gx + rotations[j, 1, 2] * gy + rotations[j, 2, 2] * gz,
    )


@no_type_check
@njit(cache=True, fastmath=True, forceinline=True)
def add_point(derivative, v, points, frame, moments, row):
    """Add one point: moments (p, 3) about each joint, and the row's translation and shape."""
    translation, joints, offsets = frame.translation, frame.joints, frame.joint_offsets
    basis, point = points.shape_basis[v], points.positions[v]
    p = joints.shape[0]
    n = basis.shape[0]
    gx, gy, gz = derivative[0], -derivative[1], -derivative[2]
    yx = point[0] - translation[0]
    yy = translation[1] - point[1]
    yz = translation[2] - point[2]
    hx = hy = hz = 0.0
    shape = 3 * p + 3
    for j in range(p):
        follow = points.joint_follow[v, j]
        if follow != 0.0:
            ax, ay, az = yx - joints[j, 0], yy - joints[j, 1], yz - joints[j, 2]
            moments[j, 0] += follow * (ay * gz - az * gy)
            moments[j, 1] += follow * (az * gx - ax * gz)
            moments[j, 2] += follow * (ax * gy - ay * gx)
        weight = points.part_weights[v, j]
        if weight != 0.0:
            tx, ty, tz = turned_back(frame.rotations, j, gx, gy, gz)
            hx += weight * tx
            hy += weight * ty
            hz += weight * tz
            wx, wy, wz = weight * gx, weight * gy, weight * gz
            for k in range(n):
                row[shape + k] += (
                    offsets[k, j, 0] * wx + offsets[k, j, 1] * wy + offsets[k, j, 2] * wz
                )
    row[3 * p] += derivative[0]
    row[3 * p + 1] += derivative[1]
    row[3 * p + 2] += derivative[2]
    for k in range(n):
        row[shape + k] += basis[k, 0] * hx + basis[k, 1] * hy + basis[k, 2] * hz


@no_type_check
@njit(cache=True, fastmath=True, forceinline=True)
def add_direction(derivative, direction, v, points, frame, rest, moments, row):
    """Add a vertex normal, which turns with the body and changes with the shape at rest.

    The rest normal is the unit vector along S = Σ u × v over the ring, so its derivative is pulled
    back to the ring's corners: by u it is v × q, by v it is q × u, with q the part of the
    derivative at right angles to the normal over |S|.
    """
    basis, corners, triangles = points.shape_basis, rest.vertices, rest.triangles
    pointers, rings = rest.pointers, rest.rings
    p = frame.rotations.shape[0]
    n = basis.shape[1]
    gx, gy, gz = derivative[0], -derivative[1], -derivative[2]
    bx, by, bz = direction[0], -direction[1], -direction[2]
    mx, my, mz = by * gz - bz * gy, bz * gx - bx * gz, bx * gy - by * gx
    hx = hy = hz = 0.0
    for j in range(p):
        follow = points.joint_follow[v, j]
        if follow != 0.0:
            moments[j, 0] += follow * mx
            moments[j, 1] += follow * my
            moments[j, 2] += follow * mz
        weight = points.part_weights[v, j]
        if weight != 0.0:
            tx, ty, tz = turned_back(frame.rotations, j, gx, gy, gz)
            hx += weight * tx
            hy += weight * ty
            hz += weight * tz
    sx = sy = sz = 0.0
    for r in range(pointers[v], pointers[v + 1]):
        t = rings[r]
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ux, uy, uz, vx, vy, vz = _sides(corners, a, b, c)
        sx += uy * vz - uz * vy
        sy += uz * vx - ux * vz
        sz += ux * vy - uy * vx
    length = sqrt(sx * sx + sy * sy + sz * sz)
    if length == 0.0:
        return
    sx, sy, sz = sx / length, sy / length, sz / length
    along = hx * sx + hy * sy + hz * sz
    qx = (hx - along * sx) / length
    qy = (hy - along * sy) / length
    qz = (hz - along * sz) / length
    shape = 3 * p + 3
    for r in range(pointers[v], pointers[v + 1]):
        t = rings[r]
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ux, uy, uz, vx, vy, vz = _sides(corners, a, b, c)
        fx, fy, fz = vy * qz - vz * qy, vz * qx - vx * qz, vx * qy - vy * qx
        ex, ey, ez = qy * uz - qz * uy, qz * ux - qx * uz, qx * uy - qy * ux
        for k in range(n):
            row[shape + k] += (
                fx * (basis[b, k, 0] - basis[a, k, 0])
                + fy * (basis[b, k, 1] - basis[a, k, 1])
                + fz * (basis[b, k, 2] - basis[a, k, 2])
                + ex * (basis[c, k, 0] - basis[a, k, 0])
                + ey * (basis[c, k, 1] - basis[a, k, 1])
                + ez * (basis[c, k, 2] - basis[a, k, 2])
            )


@no_type_check
@njit(cache=True, fastmath=True, forceinline=True)
def _sides(corners, a, b, c):
    """The sides u and v of a triangle from its first corner."""
    ux = corners[b, 0] - corners[a, 0]
    uy = corners[b, 1] - corners[a, 1]
    uz = corners[b, 2] - corners[a, 2]
    vx = corners[c, 0] - corners[a, 0]
    vy = corners[c, 1] - corners[a, 1]
    vz = corners[c, 2] - corners[a, 2]
    return ux, uy, uz, vx, vy, vz


@no_type_check
@njit(cache=True, fastmath=True, forceinline=True)
def turn_columns(moments, parent_rotations, row):
    """Convert moments about joints to the columns of turns about their parents' axes."""
    for j in range(moments.shape[0]):
        for axis in range(3):
            row[3 * j + axis] = (
                parent_rotations[j, 0, axis] * moments[j, 0]
                + parent_rotations[j, 1, axis] * moments[j, 1]
                + parent_rotations[j, 2, axis] * moments[j, 2]
            )


@no_type_check
@njit(cache=True, fastmath=True)
def position_row_jacobian(derivatives, chosen, scales, points, frame, result):
    """Rows over the parameters, each multiplied by its ``scales``; ``result`` (k, columns)."""
    moments = np.empty(frame.joints.shape)
    for k in range(derivatives.shape[0]):
        row = result[k]
        row[:] = 0.0
        moments[:] = 0.0
        for q in range(derivatives.shape[1]):
            add_point(derivatives[k, q], chosen[k, q], points, frame, moments, row)
        turn_columns(moments, frame.parent_rotations, row)
        for c in range(row.shape[0]):
            row[c] *= scales[k]


@no_type_check
@njit(cache=True, fastmath=True)
def shading_row_jacobian(
    by_position, by_normal, chosen, scales, normals, points, frame, rest, result
):
    """The same for rows that depend on one vertex's position and normal."""
    moments = np.empty(frame.joints.shape)
    for k in range(len(chosen)):
        v = chosen[k]
        row = result[k]
        row[:] = 0.0
        moments[:] = 0.0
        add_point(by_position[k], v, points, frame, moments, row)
        add_direction(by_normal[k], normals[v], v, points, frame, rest, moments, row)
        turn_columns(moments, frame.parent_rotations, row)
        for c in range(row.shape[0]):
            row[c] *= scales[k]


@no_type_check
@njit(cache=True, fastmath=True)
def scatter(forces, points, derivatives, result):
    """Add force times derivative to each row's points."""
    for k in range(derivatives.shape[0]):
        for q in range(derivatives.shape[1]):
            v = points[k, q]
            for axis in range(3):
                result[v, axis] += forces[k] * derivatives[k, q, axis]


@no_type_check
@njit(cache=True, fastmath=True)
def scatter_sums(by_sums, pointers, indices, weights, result):
    """Add the derivative by each sum, times the weights, to the points in the sum."""
    for s in range(len(pointers) - 1):
        for entry in range(pointers[s], pointers[s + 1]):
            for axis in range(3):
                result[indices[entry], axis] += weights[entry] * by_sums[s, axis]
