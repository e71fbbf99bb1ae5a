"""Numba kernels of the terms of :mod:`fitter.pose_init.click_problem`: their energies, their rows.

Every term has a function for its energy and one that adds its rows, weighted derivatives and
residuals, to the normal equations.

Sizes: p parts, k landmarks of which the first c were clicked, s slants, h hints, j turning joints,
n = 3 j (+ 3) columns. All for one pose.
"""

from typing import NamedTuple, no_type_check

import numpy as np
from numba import njit

from fitter.numerics._damping_kernels import (
    FIRST_RISE,
    PROMISED_AFTER_REJECTION,
    Damping,
    after_gain,
    after_rejection,
    damped_step,
)
from fitter.numerics._rotation_kernels import (
    SERIES_BELOW,
    SMALL_ANGLE,
    composed,
    inverse_left_jacobians,
    rodrigues,
)
from fitter.pose_init._landmark_kernels import landmark_moves, pose_rig

_NEAR_PLANE_M = 0.05


class Clicks(NamedTuple):
    """Pixels (c, 2), their precision (c,), and focal length and centre (3,) of the camera."""

    pixels: np.ndarray
    precision: np.ndarray
    camera: np.ndarray


class Prior(NamedTuple):
    """The arrays of a :class:`~fitter.body.pose_prior.PosePrior`, and how soft limits are."""

    axes: np.ndarray
    mean: np.ndarray
    precision: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    softness: float


class Facings(NamedTuple):
    """Slants (s, k) that should be negative by a margin, in metres, and their spread."""

    rows: np.ndarray
    margin: float
    spread: float


class Hints(NamedTuple):
    """The arrays of :class:`~fitter.pose_init.click_problem.SlantHints`; Huber's threshold."""

    rows: np.ndarray
    toward: np.ndarray
    reach: np.ndarray
    precision: np.ndarray
    truncation: float


class Terms(NamedTuple):
    """All terms; ``trunk_spreads`` (2,) are those of the hips' axis and of the trunk's long one."""

    clicks: Clicks
    prior: Prior
    facings: Facings
    hints: Hints
    trunk_spreads: np.ndarray


class Unknowns(NamedTuple):
    """The turning joints (j,), and whether the root's position is sought too."""

    turning: np.ndarray
    moving: bool


class Limits(NamedTuple):
    """Limits of a search: steps, the gain below which it ends, dampings, the matrix's floor."""

    steps: int
    settled: float
    damping: float
    largest_damping: float
    floor: float


class Equations(NamedTuple):
    """JᵀJ, of which only the lower triangle is filled until all terms are in, and Jᵀr."""

    matrix: np.ndarray
    gradient: np.ndarray


@no_type_check
@njit(cache=True)
def add_row(row, residual, equations):
    """Add a residual's row (n,) to the normal equations; most of its entries are zero."""
    used = np.empty(len(row), dtype=np.int64)
    count = 0
    for column in range(len(row)):
        if row[column] != 0.0:
            used[count] = column
            count += 1
    for i in range(count):
        value = row[used[i]]
        equations.gradient[used[i]] += value * residual
        for j in range(i + 1):
            equations.matrix[used[i], used[j]] += value * row[used[j]]


@no_type_check
@njit(cache=True)
def click_residual(points, clicks, click, axis):
    """Standard deviations from a click to its landmark, to the right or down."""
    seen = clicks.camera[0] * points[click, axis] / points[click, 2] + clicks.camera[1 + axis]
    return clicks.precision[click] * (seen - clicks.pixels[click, axis])


@no_type_check
@njit(cache=True)
def click_energy(points, clicks):
    """½ Σ r²; infinite where a clicked point is behind the camera."""
    energy = 0.0
    for click in range(len(clicks.pixels)):
        if points[click, 2] <= _NEAR_PLANE_M:
            return np.inf
        for axis in range(2):
            energy += 0.5 * click_residual(points, clicks, click, axis) ** 2
    return energy


@no_type_check
@njit(cache=True)
def add_clicks(points, moves, clicks, row, equations):
    """∂(x/z) = (∂x - x/z ∂z) / z, and for y."""
    for click in range(len(clicks.pixels)):
        scale = clicks.precision[click] * clicks.camera[0] / points[click, 2]
        for axis in range(2):
            ratio = points[click, axis] / points[click, 2]
            for c in range(len(row)):
                row[c] = scale * (moves[click, axis, c] - ratio * moves[click, 2, c])
            add_row(row, click_residual(points, clicks, click, axis), equations)


@no_type_check
@njit(cache=True)
def slant_beyond(points, facings, slant):
    """By how much a limb whose facing was told has its far end too far away, metres; or zero."""
    depth = facings.margin
    for k in range(len(points)):
        depth += facings.rows[slant, k] * points[k, 2]
    return max(depth, 0.0)


@no_type_check
@njit(cache=True)
def facing_energy(points, facings):
    """½ Σ (metres too far / spread)²."""
    energy = 0.0
    for slant in range(len(facings.rows)):
        energy += 0.5 * (slant_beyond(points, facings, slant) / facings.spread) ** 2
    return energy


@no_type_check
@njit(cache=True)
def add_facings(points, moves, facings, row, equations):
    """Rows of the limbs that face the wrong way."""
    for slant in range(len(facings.rows)):
        beyond = slant_beyond(points, facings, slant)
        if beyond > 0.0:
            row[:] = 0.0
            for k in range(len(points)):
                if facings.rows[slant, k] != 0.0:
                    row += (facings.rows[slant, k] / facings.spread) * moves[k, 2]
            add_row(row, beyond / facings.spread, equations)


@no_type_check
@njit(cache=True)
def hint_residual(points, hints, hint):
    """Standard deviations by which a limb reaches farther along the view than hinted."""
    excess = -hints.reach[hint]
    for k in range(len(points)):
        if hints.rows[hint, k] != 0.0:
            for r in range(3):
                excess += hints.rows[hint, k] * hints.toward[r] * points[k, r]
    return hints.precision[hint] * excess


@no_type_check
@njit(cache=True)
def hint_energy(points, hints):
    """Huber's loss."""
    energy = 0.0
    for hint in range(len(hints.rows)):
        size = abs(hint_residual(points, hints, hint))
        if size > hints.truncation:
            energy += hints.truncation * (size - 0.5 * hints.truncation)
        else:
            energy += 0.5 * size * size
    return energy


@no_type_check
@njit(cache=True)
def add_hints(points, moves, hints, row, equations):
    """Reweighted: row and residual by the square root of Huber's weight."""
    for hint in range(len(hints.rows)):
        residual = hint_residual(points, hints, hint)
        root = np.sqrt(hints.truncation / max(abs(residual), hints.truncation))
        row[:] = 0.0
        for k in range(len(points)):
            if hints.rows[hint, k] != 0.0:
                factor = root * hints.precision[hint] * hints.rows[hint, k]
                for r in range(3):
                    row += (factor * hints.toward[r]) * moves[k, r]
        add_row(row, root * residual, equations)


@no_type_check
@njit(cache=True)
def trunk_energy(root, spreads):
    """Energy of the root's rotation: its x and y axes' slants from the image plane, as sines."""
    return 0.5 * ((root[2, 0] / spreads[0]) ** 2 + (root[2, 1] / spreads[1]) ** 2)


@no_type_check
@njit(cache=True)
def add_trunk(root, spreads, row, equations):
    """∂(R e) = δ × R e, of which the z part is δx (R e)_y - δy (R e)_x; the root's columns lead."""
    for axis in range(2):
        row[:] = 0.0
        row[0] = root[1, axis] / spreads[axis]
        row[1] = -root[0, axis] / spreads[axis]
        add_row(row, root[2, axis] / spreads[axis], equations)


@no_type_check
@njit(cache=True)
def joint_residuals(pose, prior, part, axis):
    """A joint's angle from the mean, and beyond its limits, in standard deviations and softness."""
    angle = 0.0
    for c in range(3):
        angle += prior.axes[part, axis, c] * pose[part, c]
    beyond = max(angle - prior.upper[part, axis], 0.0) + min(angle - prior.lower[part, axis], 0.0)
    departure = prior.precision[part, axis] * (angle - prior.mean[part, axis])
    return departure, beyond / prior.softness


@no_type_check
@njit(cache=True)
def prior_energy(pose, prior):
    """Half the sum of squares of all joints."""
    energy = 0.0
    for part in range(len(pose)):
        for axis in range(3):
            departure, beyond = joint_residuals(pose, prior, part, axis)
            energy += 0.5 * (departure * departure + beyond * beyond)
    return energy


@no_type_check
@njit(cache=True)
def add_prior(pose, prior, turning, equations):
    """Each turning joint in its own block."""
    by_increment = np.empty((len(pose), 3, 3))
    inverse_left_jacobians(pose, SERIES_BELOW, by_increment)
    for index in range(len(turning)):
        part, first = turning[index], 3 * index
        for axis in range(3):
            departure, beyond = joint_residuals(pose, prior, part, axis)
            firmness = prior.precision[part, axis] ** 2
            pull = prior.precision[part, axis] * departure
            if beyond != 0.0:
                firmness += 1.0 / prior.softness**2
                pull += beyond / prior.softness
            for r in range(3):
                slope = 0.0
                for c in range(3):
                    slope += prior.axes[part, axis, c] * by_increment[part, c, r]
                equations.gradient[first + r] += pull * slope
                for s in range(r + 1):
                    other = 0.0
                    for c in range(3):
                        other += prior.axes[part, axis, c] * by_increment[part, c, s]
                    equations.matrix[first + r, first + s] += firmness * slope * other


@no_type_check
@njit(cache=True)
def evaluate(rig, terms, pose, translation):
    """The landmarks of a pose, and the sum of all terms."""
    local = np.empty((len(pose), 3, 3))
    rodrigues(pose, SMALL_ANGLE, local)
    posed = pose_rig(rig, local, translation)
    energy = (
        click_energy(posed.points, terms.clicks)
        + facing_energy(posed.points, terms.facings)
        + hint_energy(posed.points, terms.hints)
        + trunk_energy(posed.rotations[0], terms.trunk_spreads)
        + prior_energy(pose, terms.prior)
    )
    return posed, energy


@no_type_check
@njit(cache=True)
def normal_equations(rig, terms, unknowns, pose, posed):
    """JᵀJ (n, n) and Jᵀr (n,) of all terms, by the columns of :func:`landmark_moves`."""
    moves = landmark_moves(rig, posed, unknowns.turning, unknowns.moving)
    n = moves.shape[2]
    row = np.empty(n)
    equations = Equations(np.zeros((n, n)), np.zeros(n))
    add_clicks(posed.points, moves, terms.clicks, row, equations)
    add_facings(posed.points, moves, terms.facings, row, equations)
    add_hints(posed.points, moves, terms.hints, row, equations)
    if unknowns.turning[0] == 0:
        add_trunk(posed.rotations[0], terms.trunk_spreads, row, equations)
    add_prior(pose, terms.prior, unknowns.turning, equations)
    for r in range(n):
        for c in range(r):
            equations.matrix[c, r] = equations.matrix[r, c]
    return equations


@no_type_check
@njit(cache=True)
def moved(unknowns, pose, translation, step):
    """Pose and root position after a step: exp(δ) exp(pose) at the turning joints."""
    new_pose, new_translation = pose.copy(), translation.copy()
    turns = 3 * len(unknowns.turning)
    turned = np.empty((len(unknowns.turning), 3))
    composed(step[:turns].reshape(-1, 3), pose[unknowns.turning], SMALL_ANGLE, turned)
    new_pose[unknowns.turning] = turned
    if unknowns.moving:
        new_translation += step[turns:]
    return new_pose, new_translation


@no_type_check
@njit(cache=True)
def descend(rig, terms, unknowns, pose, translation, limits):
    """:func:`fitter.numerics.damped_descent.descend` on a pose; returns the pose and its energy.

    Compiled because every point that is moved asks ``/v1/initial-poses``: around the same kernels,
    the loop in Python took 18 ms of a processor in place of 6.5 for the 45 searches of a picture,
    where all of an initial pose takes 15.
    """
    posed, energy = evaluate(rig, terms, pose, translation)
    damping, tried, small_gains = Damping(limits.damping, FIRST_RISE), 0, 0
    while tried < limits.steps and small_gains < 2:
        matrix, gradient = normal_equations(rig, terms, unknowns, pose, posed)
        before, most_promised = energy, np.inf
        while tried < limits.steps and damping.share < limits.largest_damping:
            step, promised = damped_step(matrix, gradient, damping.share, limits.floor)
            if promised < limits.settled:
                return pose, translation, energy
            if promised <= most_promised:
                new_pose, new_translation = moved(unknowns, pose, translation, step)
                new_posed, new_energy = evaluate(rig, terms, new_pose, new_translation)
                tried += 1
                if new_energy < energy:
                    pose, translation, posed = new_pose, new_translation, new_posed
                    damping = after_gain(damping, (energy - new_energy) / promised)
                    energy = new_energy
                    break
                most_promised = PROMISED_AFTER_REJECTION * promised
            damping = after_rejection(damping)
        if energy == before:
            break
        small_gains = small_gains + 1 if before - energy < limits.settled else 0
    return pose, translation, energy
