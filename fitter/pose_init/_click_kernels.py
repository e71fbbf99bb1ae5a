"""Numba kernels of the fit to clicks; see :mod:`fitter.pose_init.click_fit` for what they compute.

Sizes: p parts, k landmarks of which the first c were clicked, s slants, h hints, j turning joints,
n = 3 j + 3 columns. All for one pose; body frame axes unless said otherwise.
"""

from typing import no_type_check

import numpy as np
from numba import njit

_SMALL = 1e-8
_NEAR_PLANE_M = 0.05


@no_type_check
@njit(cache=True)
def rotation_matrix(vector, result):
    """Rodrigues' formula."""
    x, y, z = vector
    squared = x * x + y * y + z * z
    angle = np.sqrt(squared)
    if angle < _SMALL:
        sine, cosine = 1.0, 0.5
    else:
        sine, cosine = np.sin(angle) / angle, (1.0 - np.cos(angle)) / squared
    result[0, 0] = 1.0 - cosine * (y * y + z * z)
    result[1, 1] = 1.0 - cosine * (x * x + z * z)
    result[2, 2] = 1.0 - cosine * (x * x + y * y)
    result[0, 1], result[1, 0] = cosine * x * y - sine * z, cosine * x * y + sine * z
    result[0, 2], result[2, 0] = cosine * x * z + sine * y, cosine * x * z - sine * y
    result[1, 2], result[2, 1] = cosine * y * z - sine * x, cosine * y * z + sine * x


@no_type_check
@njit(cache=True)
def turn_further(increment, vector):
    """Replace ``vector`` by log(exp(increment) exp(vector)), by unit quaternions."""
    a, b = np.empty(4), np.empty(4)
    for source, target in ((increment, a), (vector, b)):
        angle = np.sqrt(source[0] ** 2 + source[1] ** 2 + source[2] ** 2)
        factor = 0.5 if angle < _SMALL else np.sin(0.5 * angle) / angle
        target[0] = np.cos(0.5 * angle)
        for c in range(3):
            target[c + 1] = factor * source[c]
    w = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3]
    x = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2]
    y = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1]
    z = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    sine = np.sqrt(x * x + y * y + z * z)
    factor = 2.0 if sine < _SMALL else 2.0 * np.arctan2(sine, w) / sine
    vector[0], vector[1], vector[2] = factor * x, factor * y, factor * z


@no_type_check
@njit(cache=True)
def pose_points(rig, pose, translation, rotations, joints, shares, points):
    """Blend landmarks: fills rotations, joints, shares (k, p, 3) and camera-frame points."""
    parents, rest_joints, weights, arms, _ = rig
    local = np.empty((3, 3))
    for part in range(len(parents)):
        parent = parents[part]
        rotation_matrix(pose[part], local)
        if parent < 0:
            rotations[part] = local
            joints[part] = 0.0
            continue
        for r in range(3):
            offset = joints[parent, r]
            for c in range(3):
                value = 0.0
                for i in range(3):
                    value += rotations[parent, r, i] * local[i, c]
                rotations[part, r, c] = value
                bone = rest_joints[part, c] - rest_joints[parent, c]
                offset += rotations[parent, r, c] * bone
            joints[part, r] = offset
    for k in range(len(points)):
        for r in range(3):
            total = 0.0
            for part in range(len(parents)):
                weight = weights[k, part]
                value = 0.0
                if weight != 0.0:
                    value = weight * joints[part, r]
                    for c in range(3):
                        value += rotations[part, r, c] * arms[k, part, c]
                    total += value
                shares[k, part, r] = value
            points[k, r] = (total if r == 0 else -total) + translation[r]


@no_type_check
@njit(cache=True)
def hint_excess(row, toward, reach, points):
    """How much farther along the view a limb reaches than hinted, metres."""
    excess = -reach
    for k in range(len(points)):
        if row[k] != 0.0:
            for r in range(3):
                excess += row[k] * toward[r] * points[k, r]
    return excess


@no_type_check
@njit(cache=True)
def residuals_energy(rig, prior, clicks, soft, pose, rotations, points):
    """Half the sum of squares of all terms; infinite where a clicked point is behind the camera."""
    parents = rig[0]
    axes, mean, precision, lower, upper, softness = prior
    pixels, certainty, camera = clicks
    slants, margin, slant_spread, lean_spread, yaw_spread, hints = soft
    hint_rows, toward, reach, hint_precision, truncation = hints
    energy = 0.0
    for i in range(len(pixels)):
        if points[i, 2] <= _NEAR_PLANE_M:
            return np.inf
        for axis in range(2):
            seen = camera[0] * points[i, axis] / points[i, 2] + camera[1 + axis]
            energy += (certainty[i] * (seen - pixels[i, axis])) ** 2
    for part in range(len(parents)):
        for a in range(3):
            angle = 0.0
            for c in range(3):
                angle += axes[part, a, c] * pose[part, c]
            energy += (precision[part, a] * (angle - mean[part, a])) ** 2
            beyond = max(angle - upper[part, a], 0.0) + min(angle - lower[part, a], 0.0)
            energy += (beyond / softness) ** 2
    for row in range(len(slants)):
        slant = margin
        for k in range(len(points)):
            slant += slants[row, k] * points[k, 2]
        energy += (max(slant, 0.0) / slant_spread) ** 2
    for row in range(len(hint_rows)):
        excess = abs(hint_excess(hint_rows[row], toward, reach[row], points)) * hint_precision[row]
        if excess > truncation:
            energy += truncation * (2.0 * excess - truncation)
        else:
            energy += excess * excess
    energy += (rotations[0, 2, 1] / lean_spread) ** 2 + (rotations[0, 2, 0] / yaw_spread) ** 2
    return 0.5 * energy


@no_type_check
@njit(cache=True)
def landmark_columns(rig, turning, rotations, joints, shares, result):
    """Derivative of camera-frame points by increments of the turning joints: (k, 3, n)."""
    parents, _, weights, _, follows = rig
    result[:] = 0.0
    axis = np.empty(3)
    for column in range(len(turning)):
        joint = turning[column]
        parent = parents[joint]
        for k in range(len(shares)):
            share = 0.0
            x, y, z = 0.0, 0.0, 0.0
            for part in range(joint, len(parents)):
                if follows[joint, part] and weights[k, part] != 0.0:
                    share += weights[k, part]
                    x += shares[k, part, 0]
                    y += shares[k, part, 1]
                    z += shares[k, part, 2]
            if share == 0.0 and x == 0.0 and y == 0.0 and z == 0.0:
                continue
            x -= share * joints[joint, 0]
            y -= share * joints[joint, 1]
            z -= share * joints[joint, 2]
            for a in range(3):
                for r in range(3):
                    if parent >= 0:
                        axis[r] = rotations[parent, r, a]
                    else:
                        axis[r] = 1.0 if r == a else 0.0
                result[k, 0, 3 * column + a] = axis[1] * z - axis[2] * y
                result[k, 1, 3 * column + a] = -(axis[2] * x - axis[0] * z)
                result[k, 2, 3 * column + a] = -(axis[0] * y - axis[1] * x)
    for k in range(len(shares)):
        for r in range(3):
            result[k, r, 3 * len(turning) + r] = 1.0


@no_type_check
@njit(cache=True)
def add_row(row, residual, matrix, gradient, used):
    """Add a residual's row to the normal equations, skipping its zeros; lower triangle only."""
    count = 0
    for c in range(len(row)):
        if row[c] != 0.0:
            used[count] = c
            count += 1
    for i in range(count):
        value = row[used[i]]
        gradient[used[i]] += value * residual
        for j in range(i + 1):
            matrix[used[i], used[j]] += value * row[used[j]]


@no_type_check
@njit(cache=True)
def add_prior(prior, turning, pose, matrix, gradient):
    """Prior and limits of the turning joints, each in its own block."""
    axes, mean, precision, lower, upper, softness = prior
    inverse, turned = np.empty((3, 3)), np.empty(3)
    for column in range(len(turning)):
        part = turning[column]
        vector = pose[part]
        squared = vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2
        half = 0.5 * np.sqrt(squared)
        if half < 1e-4:
            factor = 1.0 / 12.0
        else:
            factor = (1.0 - half * np.cos(half) / np.sin(half)) / squared
        for r in range(3):
            for c in range(3):
                inverse[r, c] = factor * vector[r] * vector[c]
            inverse[r, r] += 1.0 - factor * squared
        inverse[0, 1] += 0.5 * vector[2]
        inverse[1, 0] -= 0.5 * vector[2]
        inverse[0, 2] -= 0.5 * vector[1]
        inverse[2, 0] += 0.5 * vector[1]
        inverse[1, 2] += 0.5 * vector[0]
        inverse[2, 1] -= 0.5 * vector[0]
        for a in range(3):
            angle = 0.0
            for c in range(3):
                angle += axes[part, a, c] * vector[c]
                turned[c] = 0.0
                for r in range(3):
                    turned[c] += axes[part, a, r] * inverse[r, c]
            firmness = precision[part, a] ** 2
            pull = firmness * (angle - mean[part, a])
            beyond = max(angle - upper[part, a], 0.0) + min(angle - lower[part, a], 0.0)
            if beyond != 0.0:
                firmness += 1.0 / softness**2
                pull += beyond / softness**2
            for r in range(3):
                gradient[3 * column + r] += pull * turned[r]
                for c in range(3):
                    matrix[3 * column + r, 3 * column + c] += firmness * turned[r] * turned[c]


@no_type_check
@njit(cache=True)
def linearise(
    rig, prior, clicks, soft, turning, pose, rotations, joints, shares, points, matrix, gradient
):
    """Normal equations of all terms: lower triangle of JᵀJ, and Jᵀr."""
    pixels, certainty, camera = clicks
    slants, margin, slant_spread, lean_spread, yaw_spread, hints = soft
    hint_rows, toward, reach, hint_precision, truncation = hints
    n = len(gradient)
    columns = np.empty((len(points), 3, n))
    landmark_columns(rig, turning, rotations, joints, shares, columns)
    matrix[:] = 0.0
    gradient[:] = 0.0
    row, used = np.empty(n), np.empty(n, dtype=np.int64)
    for i in range(len(pixels)):
        scale = certainty[i] * camera[0] / points[i, 2]
        for axis in range(2):
            ratio = points[i, axis] / points[i, 2]
            for c in range(n):
                row[c] = scale * (columns[i, axis, c] - ratio * columns[i, 2, c])
            seen = camera[0] * ratio + camera[1 + axis]
            add_row(row, certainty[i] * (seen - pixels[i, axis]), matrix, gradient, used)
    for index in range(len(slants)):
        slant = margin
        row[:] = 0.0
        for k in range(len(points)):
            if slants[index, k] != 0.0:
                slant += slants[index, k] * points[k, 2]
                for c in range(n):
                    row[c] += slants[index, k] * columns[k, 2, c] / slant_spread
        if slant > 0.0:
            add_row(row, slant / slant_spread, matrix, gradient, used)
    for index in range(len(hint_rows)):
        excess = hint_excess(hint_rows[index], toward, reach[index], points)
        # Reweighted least squares: the square root of Huber's weight, on row and residual.
        scale = hint_precision[index]
        if abs(excess) * scale > truncation:
            scale = np.sqrt(truncation * scale / abs(excess))
        row[:] = 0.0
        for k in range(len(points)):
            if hint_rows[index, k] != 0.0:
                for r in range(3):
                    factor = scale * hint_rows[index, k] * toward[r]
                    for c in range(n):
                        row[c] += factor * columns[k, r, c]
        add_row(row, scale * excess, matrix, gradient, used)
    if len(turning) and turning[0] == 0:
        for axis, spread in ((1, lean_spread), (0, yaw_spread)):
            row[:] = 0.0
            row[0] = rotations[0, 1, axis] / spread
            row[1] = -rotations[0, 0, axis] / spread
            add_row(row, rotations[0, 2, axis] / spread, matrix, gradient, used)
    add_prior(prior, turning, pose, matrix, gradient)


@no_type_check
@njit(cache=True)
def solve_in_place(matrix, vector):
    """Solve with the lower triangle of a symmetric matrix by Cholesky; False if not definite."""
    n = len(vector)
    for c in range(n):
        for r in range(c, n):
            value = matrix[r, c]
            for i in range(c):
                value -= matrix[r, i] * matrix[c, i]
            if r == c:
                if value <= 0.0:
                    return False
                matrix[c, c] = np.sqrt(value)
            else:
                matrix[r, c] = value / matrix[c, c]
    for r in range(n):
        for i in range(r):
            vector[r] -= matrix[r, i] * vector[i]
        vector[r] /= matrix[r, r]
    for r in range(n - 1, -1, -1):
        for i in range(r + 1, n):
            vector[r] -= matrix[i, r] * vector[i]
        vector[r] /= matrix[r, r]
    return True


@no_type_check
@njit(cache=True)
def descend(rig, prior, clicks, soft, turning, columns, pose, translation, rules):
    """Damped Gauss-Newton from one pose; changes pose and translation, returns the energy.

    ``columns`` says how many columns move: all n, or 3 fewer if the position is held.
    """
    iterations, tolerance, first_damping, most_damping, trace = rules
    p, k = len(pose), len(rig[2])
    rotations, joints = np.empty((p, 3, 3)), np.empty((p, 3))
    shares, points = np.empty((k, p, 3)), np.empty((k, 3))
    n = 3 * len(turning) + 3
    matrix, gradient = np.empty((n, n)), np.empty(n)
    new_pose, new_translation = pose.copy(), translation.copy()
    pose_points(rig, pose, translation, rotations, joints, shares, points)
    energy = residuals_energy(rig, prior, clicks, soft, pose, rotations, points)
    damping = first_damping
    fresh = True
    damped = np.empty((columns, columns))
    for _ in range(int(iterations)):
        if fresh:
            linearise(
                rig, prior, clicks, soft, turning, pose, rotations, joints, shares, points,
                matrix, gradient,
            )  # fmt: skip
        damped[:] = matrix[:columns, :columns]
        for c in range(columns):
            damped[c, c] += damping * damped[c, c] + trace
        step = -gradient[:columns]
        new_energy = np.inf
        if solve_in_place(damped, step):
            new_pose[:] = pose
            new_translation[:] = translation
            for column in range(len(turning)):
                turn_further(step[3 * column : 3 * column + 3], new_pose[turning[column]])
            for c in range(columns - 3 * len(turning)):
                new_translation[c] += step[3 * len(turning) + c]
            pose_points(rig, new_pose, new_translation, rotations, joints, shares, points)
            new_energy = residuals_energy(rig, prior, clicks, soft, new_pose, rotations, points)
        if new_energy < energy:
            pose[:] = new_pose
            translation[:] = new_translation
            gained = energy - new_energy
            energy = new_energy
            damping *= 0.2
            fresh = True
            if gained < tolerance:
                break
        else:
            if damping >= most_damping:
                break
            damping *= 10.0
            fresh = False
    return energy
