"""Compiled rows of the Gauss-Newton matrix: derivatives of residuals by all body parameters.

The result of :func:`fitter.body.tangent.point_jacobian` and ``direction_jacobian`` contracted with
each row's own derivative, without ever storing those Jacobians. For a camera-frame derivative d at
a point x, with g = diag(1, -1, -1) d and y the point relative to the root in body axes, a turn of
joint j about an axis e of its parent changes the residual by

    e . ((y - c_j) × g), times how far the point follows joint j.

What these loops call is inlined by force: of a function that stays one, the process that compiles
it and one that loads it may run different machine code, which rounds otherwise.
"""

from math import sqrt
from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, fastmath=True, forceinline=True)
def add_point(
    derivative,
    point,
    translation,
    joint_follow,
    part_weights,
    shape_basis,
    rotations,
    joints,
    joint_offsets,
    moments,
    row,
):
    """Add one point: moments (p, 3) about each joint, and the row's translation and shape."""
    p = rotations.shape[0]
    n = shape_basis.shape[0]
    gx, gy, gz = derivative[0], -derivative[1], -derivative[2]
    yx = point[0] - translation[0]
    yy = translation[1] - point[1]
    yz = translation[2] - point[2]
    hx = hy = hz = 0.0
    shape = 3 * p + 3
    for j in range(p):
        follow = joint_follow[j]
        if follow != 0.0:
            ax, ay, az = yx - joints[j, 0], yy - joints[j, 1], yz - joints[j, 2]
            moments[j, 0] += follow * (ay * gz - az * gy)
            moments[j, 1] += follow * (az * gx - ax * gz)
            moments[j, 2] += follow * (ax * gy - ay * gx)
        weight = part_weights[j]
        if weight != 0.0:
            hx += weight * (
                rotations[j, 0, 0] * gx + rotations[j, 1, 0] * gy + rotations[j, 2, 0] * gz
            )
            hy += weight * (
                rotations[j, 0, 1] * gx + rotations[j, 1, 1] * gy + rotations[j, 2, 1] * gz
            )
            hz += weight * (
                rotations[j, 0, 2] * gx + rotations[j, 1, 2] * gy + rotations[j, 2, 2] * gz
            )
            wx, wy, wz = weight * gx, weight * gy, weight * gz
            for k in range(n):
                row[shape + k] += (
                    joint_offsets[k, j, 0] * wx
                    + joint_offsets[k, j, 1] * wy
                    + joint_offsets[k, j, 2] * wz
                )
    row[3 * p] += derivative[0]
    row[3 * p + 1] += derivative[1]
    row[3 * p + 2] += derivative[2]
    for k in range(n):
        row[shape + k] += shape_basis[k, 0] * hx + shape_basis[k, 1] * hy + shape_basis[k, 2] * hz


@no_type_check
@njit(cache=True, fastmath=True, forceinline=True)
def add_direction(
    derivative,
    direction,
    vertex,
    joint_follow,
    part_weights,
    shape_basis,
    rotations,
    rest,
    triangles,
    pointers,
    rings,
    moments,
    row,
):
    """The same for a vertex normal, which turns with the body and changes with the rest shape.

    The rest normal is the unit vector along S = Σ u × v over the ring, so its derivative is pulled
    back to the ring's corners: by u it is v × q, by v it is q × u, with q the part of the
    derivative at right angles to the normal over |S|.
    """
    p = rotations.shape[0]
    n = shape_basis.shape[1]
    gx, gy, gz = derivative[0], -derivative[1], -derivative[2]
    bx, by, bz = direction[0], -direction[1], -direction[2]
    mx, my, mz = by * gz - bz * gy, bz * gx - bx * gz, bx * gy - by * gx
    hx = hy = hz = 0.0
    for j in range(p):
        follow = joint_follow[j]
        if follow != 0.0:
            moments[j, 0] += follow * mx
            moments[j, 1] += follow * my
            moments[j, 2] += follow * mz
        weight = part_weights[j]
        if weight != 0.0:
            hx += weight * (
                rotations[j, 0, 0] * gx + rotations[j, 1, 0] * gy + rotations[j, 2, 0] * gz
            )
            hy += weight * (
                rotations[j, 0, 1] * gx + rotations[j, 1, 1] * gy + rotations[j, 2, 1] * gz
            )
            hz += weight * (
                rotations[j, 0, 2] * gx + rotations[j, 1, 2] * gy + rotations[j, 2, 2] * gz
            )
    sx = sy = sz = 0.0
    for r in range(pointers[vertex], pointers[vertex + 1]):
        t = rings[r]
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ux, uy, uz = rest[b, 0] - rest[a, 0], rest[b, 1] - rest[a, 1], rest[b, 2] - rest[a, 2]
        vx, vy, vz = rest[c, 0] - rest[a, 0], rest[c, 1] - rest[a, 1], rest[c, 2] - rest[a, 2]
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
    for r in range(pointers[vertex], pointers[vertex + 1]):
        t = rings[r]
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ux, uy, uz = rest[b, 0] - rest[a, 0], rest[b, 1] - rest[a, 1], rest[b, 2] - rest[a, 2]
        vx, vy, vz = rest[c, 0] - rest[a, 0], rest[c, 1] - rest[a, 1], rest[c, 2] - rest[a, 2]
        fx, fy, fz = vy * qz - vz * qy, vz * qx - vx * qz, vx * qy - vy * qx
        ex, ey, ez = qy * uz - qz * uy, qz * ux - qx * uz, qx * uy - qy * ux
        for k in range(n):
            row[shape + k] += (
                fx * (shape_basis[b, k, 0] - shape_basis[a, k, 0])
                + fy * (shape_basis[b, k, 1] - shape_basis[a, k, 1])
                + fz * (shape_basis[b, k, 2] - shape_basis[a, k, 2])
                + ex * (shape_basis[c, k, 0] - shape_basis[a, k, 0])
                + ey * (shape_basis[c, k, 1] - shape_basis[a, k, 1])
                + ez * (shape_basis[c, k, 2] - shape_basis[a, k, 2])
            )


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
def position_row_jacobian(
    derivatives,
    points,
    scales,
    positions,
    translation,
    joint_follow,
    part_weights,
    shape_basis,
    rotations,
    parent_rotations,
    joints,
    joint_offsets,
    result,
):
    """Rows over the parameters, each multiplied by its ``scales``; ``result`` (k, columns)."""
    moments = np.empty(joints.shape)
    for k in range(derivatives.shape[0]):
        row = result[k]
        row[:] = 0.0
        moments[:] = 0.0
        for q in range(derivatives.shape[1]):
            v = points[k, q]
            add_point(
                derivatives[k, q],
                positions[v],
                translation,
                joint_follow[v],
                part_weights[v],
                shape_basis[v],
                rotations,
                joints,
                joint_offsets,
                moments,
                row,
            )
        turn_columns(moments, parent_rotations, row)
        for c in range(row.shape[0]):
            row[c] *= scales[k]


@no_type_check
@njit(cache=True, fastmath=True)
def shading_row_jacobian(
    position_derivatives,
    normal_derivatives,
    vertices,
    scales,
    positions,
    normals,
    translation,
    joint_follow,
    part_weights,
    shape_basis,
    rotations,
    parent_rotations,
    joints,
    joint_offsets,
    rest,
    triangles,
    pointers,
    rings,
    result,
):
    """The same for rows that depend on one vertex's position and normal."""
    moments = np.empty(joints.shape)
    for k in range(len(vertices)):
        v = vertices[k]
        row = result[k]
        row[:] = 0.0
        moments[:] = 0.0
        add_point(
            position_derivatives[k],
            positions[v],
            translation,
            joint_follow[v],
            part_weights[v],
            shape_basis[v],
            rotations,
            joints,
            joint_offsets,
            moments,
            row,
        )
        add_direction(
            normal_derivatives[k],
            normals[v],
            v,
            joint_follow[v],
            part_weights[v],
            shape_basis,
            rotations,
            rest,
            triangles,
            pointers,
            rings,
            moments,
            row,
        )
        turn_columns(moments, parent_rotations, row)
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
