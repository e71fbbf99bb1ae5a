"""Our body fitted to a posed mesh of another maker: how well its shapes can say who that is.

Closest points, renewed after each step, weighed by normals and a robust function, both ways: from
our vertices to the mesh, so that nothing of ours stands off it, and from its vertices to ours, so
that none of its limbs is left out. The search starts at the joints. Standard normal priors on shape
and pose are small beside some ten thousand distances.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from fitter.arrays import PerVertex, Triangles, Vertices
from fitter.body.model import regress
from fitter.body.pose_prior import mean_pose, prior_residuals, prior_terms
from fitter.body.scape import CAMERA_AXES
from fitter.body.tangent import attached_rows, linearise
from fitter.energies.fitting_operators import FittingOperators
from fitter.fits.prepared_model import prepared_model
from fitter.optimizer.free_space import excess, moved
from fitter.parameters import BodyParameters
from fitter.training.articulation.parts import part_index
from fitter.vocabulary.choices import Gender
from tests.evaluation.closest_points import (
    SURFACE_SPREAD_M,
    Pairs,
    Surface,
    closest_pairs,
    distances_m,
    nearest_numbers,
    surface_of,
)
from tests.evaluation.joint_figures import Joints
from tests.unit.body.plain_tangent import point_jacobian

JOINT_SPREAD_M = 0.02
"""Joints of another skeleton lie a centimetre or two from ours."""

JOINT_STEPS, SURFACE_STEPS = 30, 60
SETTLED_SHARE = 1e-4
"""A step that lowers the energy by a smaller share is the last."""

FIRST_DAMPING, LARGEST_DAMPING = 1e-2, 1e3

_SIDES = ("left", "right")

_BATCH = 2000
"""Pairs whose Jacobians are held at a time."""

TRUNK_PARTS = ("pelvis", "spine", "chest")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PosedMesh:
    """A body of any topology in the camera frame, metres, with what is known of its joints."""

    gender: Gender
    vertices: Vertices
    triangles: Triangles
    joints: Joints


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeshFit:
    """Our body on a mesh.

    ``body_mm`` and ``trunk_mm`` are root mean square distances of the mesh's vertices from our
    surface, of all but the hands and of those nearest to our trunk.
    """

    parameters: BodyParameters
    vertices: Vertices
    body_mm: float
    trunk_mm: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Matched:
    """A body with its pairs, both ways; ``energy`` in nats."""

    parameters: BodyParameters
    vertices: Vertices
    pairs: tuple[Pairs, Pairs]
    energy: float


def fit_mesh(mesh: PosedMesh, *, coefficients: int | None = None) -> MeshFit:
    """Fit pose, place and the first ``coefficients`` of the shape, by default all."""
    operators = prepared_model(mesh.gender).operators
    free = _free_columns(operators, coefficients)
    surface = surface_of(mesh.vertices, mesh.triangles)
    now = _matched(_from_joints(mesh, operators), surface, operators)
    damping, gained = FIRST_DAMPING, np.inf
    matrix, pull = _normal_equations(now, operators)
    for _ in range(SURFACE_STEPS):
        reached = _stepped(now.parameters, matrix, pull, free, damping)
        tried = _matched(reached, surface, operators)
        if tried.energy >= now.energy:
            damping *= 5.0
            if damping > LARGEST_DAMPING:
                break
            continue
        gained = 1.0 - tried.energy / now.energy
        now, damping = tried, damping / 3.0
        if gained < SETTLED_SHARE:
            break
        matrix, pull = _normal_equations(now, operators)
    away = distances_m(mesh.vertices, surface_of(now.vertices, operators.model.triangles))
    nearest = _nearest_part(mesh, now.vertices, operators)
    hands = np.isin(nearest, [part_index(f"{side}_hand") for side in _SIDES])
    trunk = np.isin(nearest, [part_index(name) for name in TRUNK_PARTS])
    return MeshFit(
        parameters=now.parameters,
        vertices=now.vertices,
        body_mm=1000.0 * _root_mean_square(away[~hands]),
        trunk_mm=1000.0 * _root_mean_square(away[trunk]),
    )


def _from_joints(mesh: PosedMesh, operators: FittingOperators) -> BodyParameters:
    """The mean shape in the pose whose joints are nearest to the mesh's."""
    known = ~np.isnan(mesh.joints).any(axis=1)
    attachments = attached_rows(operators.tangent, operators.model.joint_regressor)
    parameters = _upright(mesh, operators)
    free = _free_columns(operators, 0)
    for _ in range(JOINT_STEPS):
        joints = regress(operators.model.joint_regressor, operators.evaluator.vertices(parameters))
        jacobian = point_jacobian(linearise(operators.tangent, parameters), attachments, joints)
        rows = jacobian[known].reshape(-1, jacobian.shape[2]) / JOINT_SPREAD_M
        missing = (joints - mesh.joints)[known].ravel() / JOINT_SPREAD_M
        matrix, pull = _priors(parameters, operators)
        parameters = _stepped(
            parameters, matrix + rows.T @ rows, pull + rows.T @ missing, free, FIRST_DAMPING
        )
    return parameters


def _upright(mesh: PosedMesh, operators: FittingOperators) -> BodyParameters:
    """The mean pose, turned and placed as the mesh's hips and shoulders are."""
    parts = [part_index(f"{side}_{part}") for part in ("thigh", "upper_arm") for side in _SIDES]
    n = len(operators.model.shape_basis)
    start = BodyParameters(
        pose=mean_pose(operators.pose_prior), translation=np.zeros(3), shape=np.zeros(n)
    )
    ours = regress(operators.model.joint_regressor, operators.evaluator.vertices(start))[parts]
    theirs = mesh.joints[parts]
    turn = Rotation.align_vectors(theirs - theirs.mean(axis=0), ours - ours.mean(axis=0))[0]
    axes = np.diag(CAMERA_AXES)
    pose = start.pose.copy()
    in_body_frame = Rotation.from_matrix(axes @ turn.as_matrix() @ axes)
    pose[0] = (in_body_frame * Rotation.from_rotvec(pose[0])).as_rotvec()
    turned = regress(
        operators.model.joint_regressor, operators.evaluator.vertices(replace(start, pose=pose))
    )[parts]
    return replace(start, pose=pose, translation=(theirs - turned).mean(axis=0))


def _matched(parameters: BodyParameters, surface: Surface, operators: FittingOperators) -> _Matched:
    vertices = operators.evaluator.vertices(parameters)
    pairs, energy = closest_pairs(vertices, operators.model.triangles, surface)
    departures = prior_residuals(operators.pose_prior, parameters.pose)
    energy += 0.5 * float((departures**2).sum() + parameters.shape @ parameters.shape)
    return _Matched(parameters=parameters, vertices=vertices, pairs=pairs, energy=energy)


def _normal_equations(
    now: _Matched, operators: FittingOperators
) -> tuple[Float[np.ndarray, "c c"], Float[np.ndarray, " c"]]:
    matrix, pull = _priors(now.parameters, operators)
    for pairs in now.pairs:
        _add_pairs(matrix, pull, pairs, now.parameters, now.vertices, operators)
    return matrix, pull


def _add_pairs(
    matrix: Float[np.ndarray, "c c"],
    pull: Float[np.ndarray, " c"],
    pairs: Pairs,
    parameters: BodyParameters,
    vertices: Vertices,
    operators: FittingOperators,
) -> None:
    """Add to the normal equations; the matrix by the tangent, the pull by the exact derivative."""
    every = operators.tangent.vertices
    frame = linearise(operators.tangent, parameters)
    for chosen in np.array_split(np.arange(len(pairs.ours)), 1 + len(pairs.ours) // _BATCH):
        ours = pairs.ours[chosen]
        attached = replace(
            every,
            part_weights=every.part_weights[ours],
            joint_follow=every.joint_follow[ours],
            shape_basis=every.shape_basis[ours],
        )
        jacobian = point_jacobian(frame, attached, vertices[ours])
        rows = np.einsum("kic,ki->kc", jacobian, pairs.along[chosen]) / SURFACE_SPREAD_M
        matrix += (pairs.weights[chosen, None] * rows).T @ rows
    slope = np.zeros_like(vertices)
    strength = pairs.weights * pairs.away_m / SURFACE_SPREAD_M**2
    np.add.at(slope, pairs.ours, strength[:, None] * pairs.along)
    derivative = operators.evaluator.derivative(parameters, slope)
    pull += np.concatenate([derivative.pose.ravel(), derivative.translation, derivative.shape])


def _priors(
    parameters: BodyParameters, operators: FittingOperators
) -> tuple[Float[np.ndarray, "c c"], Float[np.ndarray, " c"]]:
    """Normal equations of the priors on pose and shape alone."""
    p, n = len(parameters.pose), len(parameters.shape)
    matrix, pull = np.zeros((3 * p + 3 + n,) * 2), np.zeros(3 * p + 3 + n)
    terms = prior_terms(operators.pose_prior, parameters.pose)
    for part in range(p):
        own = slice(3 * part, 3 * part + 3)
        rows = terms.jacobian[part]
        matrix[own, own] += rows.T @ rows
        pull[own] += rows.T @ terms.residuals[part]
    shape = np.arange(3 * p + 3, 3 * p + 3 + n)
    matrix[shape, shape] += 1.0
    pull[shape] += parameters.shape
    return matrix, pull


def _free_columns(
    operators: FittingOperators, coefficients: int | None
) -> Bool[np.ndarray, " columns"]:
    """Pose and place, and the first coefficients of the shape."""
    p, n = len(operators.model.part_names), len(operators.model.shape_basis)
    free = np.ones(3 * p + 3 + n, dtype=np.bool_)
    if coefficients is not None:
        free[3 * p + 3 + coefficients :] = False
    return free


def _stepped(
    parameters: BodyParameters,
    matrix: Float[np.ndarray, "c c"],
    pull: Float[np.ndarray, " c"],
    free: Bool[np.ndarray, " c"],
    damping: float,
) -> BodyParameters:
    inner = matrix[np.ix_(free, free)]
    damped = inner + np.diag(damping * inner.diagonal())
    step = np.zeros(len(pull))
    step[free] = np.linalg.solve(damped, -pull[free])
    return moved(parameters, step / max(excess(parameters, step), 1.0))


def _nearest_part(
    mesh: PosedMesh, vertices: Vertices, operators: FittingOperators
) -> Integer[np.ndarray, " v"]:
    """The part of our body that each vertex of a mesh lies nearest to."""
    model = operators.model
    part = np.zeros(len(vertices), dtype=np.intp)
    part[model.triangles] = model.part_of_triangle[:, None]
    return part[nearest_numbers(KDTree(vertices), mesh.vertices)]


def _root_mean_square(values: PerVertex) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
