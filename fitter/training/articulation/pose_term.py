"""The pose-dependent deformation E(β, θ), learned by ridge regression in each part's frame.

SCAPE asks of every triangle t of part p the deformation gradient R_p [D_t(β) + E_t]. E is linear in
the features (R - I) of the joints next to the part: a sine and a cosine of each angle, so that a
bulge may grow with the bend or with its square, while a body at rest is left alone. Of the
shoulders, whose blades go along by a share of the arm's angle, half turns count too
(:mod:`fitter.body.scape`): without, arms are off by 4.5 mm in place of 2.9. How far
a feature a acts on a part grows with the body, because E has to make up for the distance between
the joint and the skin, and that differs between a stout and a lean thigh::

    E_p(β, θ) = Σ_a (1 + s_pa . β) x_pa(θ) E_pa

The paper's SCAPE has E depend on the pose alone. Strengths s are linear in β, so height stays
linear in the shape. They are fitted to the vertices that E moves, not to gradients: a gradient
wrong by little all round a hip moves the whole leg.

Only G_pᵀ W_p E_p ever enters the least squares (see :mod:`fitter.body.scape`), so that product is
regressed itself, in place of the E_t: three numbers an incidence instead of six a triangle, the
same regression because it is linear.

With features x, shape β and ψ = x ⊗ [1, β], all that the fit needs of the examples is Σ ψ ψᵀ and
Σ ψ yᵀ, so they are read once and forgotten. E and s are solved in turn, each a linear ridge
regression with the other held. Every output has its own entries of E, which therefore know no
weighing of outputs against each other; all share s, which is fitted in the metric asked for.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.linalg import solve
from scipy.sparse.linalg import splu

from fitter.arrays import Pose, Shape, Vertices
from fitter.body.model import global_rotations
from fitter.body.scape import FeatureJoints, pose_features
from fitter.training.articulation.parts import (
    PART_NAMES,
    PART_PARENT,
    Parts,
    part_index,
    side_and_limb,
)

TURNS = 3
"""Rounds in which P and s are solved in turn. The second changes the error by 0.3 %, the third by
less than 0.01 %."""

STRENGTH_RIDGE = 1e-2
"""Relative, on s: keeps the strengths of rare shapes near those of common ones."""

_BATCH = 64


class BilinearSums:
    """Sums over examples of one regression."""

    def __init__(self, *, feature_count: int, shape_count: int, output_count: int) -> None:
        self._shape = (feature_count, shape_count + 1)
        size = feature_count * (shape_count + 1)
        self._squares = np.zeros((size, size))
        self._products = np.zeros((size, output_count))
        self._waiting: list[tuple[np.ndarray, np.ndarray]] = []

    def add(
        self,
        features: Float[np.ndarray, " a"],
        shape: Shape,
        output: Float[np.ndarray, " o"],
    ) -> None:
        """Count one example."""
        augmented = np.multiply.outer(features, np.concatenate([[1.0], shape]))
        self._waiting.append((augmented.reshape(-1), output))
        if len(self._waiting) == _BATCH:
            self._flush()

    def squares(self) -> Float[np.ndarray, "a k a k"]:
        """Σ ψ ψᵀ, by feature and factor (1, β) on both sides."""
        self._flush()
        return self._squares.reshape(*self._shape, *self._shape)

    def products(self) -> Float[np.ndarray, "a k o"]:
        """Σ ψ yᵀ."""
        self._flush()
        return self._products.reshape(*self._shape, -1)

    def _flush(self) -> None:
        if self._waiting:
            augmented = np.stack([pair[0] for pair in self._waiting])
            outputs = np.stack([pair[1] for pair in self._waiting])
            self._squares += augmented.T @ augmented
            self._products += augmented.T @ outputs
            self._waiting.clear()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BilinearSolution:
    """P, one row a feature, and s, by feature and shape coefficient."""

    linear: Float[np.ndarray, "a o"]
    strengths: Float[np.ndarray, "a n"]


def solve_bilinear(
    sums: BilinearSums, ridge: float, motion: Float[np.ndarray, "v i"]
) -> BilinearSolution:
    """Solve P and s in turn from s = 0.

    Parameters
    ----------
    sums
        Of the examples, with 3 i outputs.
    ridge
        On P, relative to the features' square.
    motion
        F such that an error e, taken as (i, 3), counts as |F e|².
    """
    squares, products = sums.squares(), sums.products()
    strengths = np.zeros((len(products), products.shape[1] - 1))
    if not squares.any():
        return BilinearSolution(linear=np.zeros_like(products[:, 0]), strengths=strengths)
    linear = _solve_linear(squares, products, strengths, ridge)
    for _ in range(TURNS):
        strengths = _solve_strengths(squares, products, linear, motion)
        linear = _solve_linear(squares, products, strengths, ridge)
    return BilinearSolution(linear=linear, strengths=strengths)


def _solve_linear(
    squares: Float[np.ndarray, "a k a k"],
    products: Float[np.ndarray, "a k o"],
    strengths: Float[np.ndarray, "a n"],
    ridge: float,
) -> Float[np.ndarray, "a o"]:
    factors = np.concatenate([np.ones((len(strengths), 1)), strengths], axis=1)
    square = np.einsum("akbl,ak,bl->ab", squares, factors, factors, optimize=True)
    right = np.einsum("ako,ak->ao", products, factors, optimize=True)
    return _ridge_solve(square, right, ridge)


def _solve_strengths(
    squares: Float[np.ndarray, "a k a k"],
    products: Float[np.ndarray, "a k o"],
    linear: Float[np.ndarray, "a o"],
    motion: Float[np.ndarray, "v i"],
) -> Float[np.ndarray, "a n"]:
    """Least squares of y - Σ_a x_a P_a on the x_a β_k P_a."""
    rows = linear.reshape(len(linear), -1, 3)
    moved = np.einsum("vi,aic->avc", motion, rows, optimize=True)
    weighed = np.einsum("vi,avc->aic", motion, moved, optimize=True).reshape(linear.shape)
    flat = moved.reshape(len(moved), -1)
    square = squares * (flat @ flat.T)[:, None, :, None]
    right = np.einsum("ako,ao->ak", products, weighed, optimize=True)
    remaining = right - square[:, :, :, 0].sum(axis=2)
    count, factors = right.shape
    size = count * (factors - 1)
    solved = _ridge_solve(
        square[:, 1:, :, 1:].reshape(size, size), remaining[:, 1:].reshape(size, 1), STRENGTH_RIDGE
    )
    return solved.reshape(count, factors - 1)


def _ridge_solve(square: np.ndarray, right: np.ndarray, ridge: float) -> np.ndarray:
    # Features that no example has leave nothing to learn: any penalty gives zero there.
    penalty = ridge * np.trace(square) / len(square) or 1.0
    return solve(square + penalty * np.eye(len(square)), right, assume_a="pos")


RIDGE = 1e-3
"""Relative to the mean square of the features. Held-out error is flat from 1e-4 to 1e-2."""

_JOINTS: Mapping[str, tuple[str, ...]] = {
    "pelvis": ("spine", "left_thigh", "right_thigh", "chest"),
    "spine": ("spine", "chest", "left_thigh", "right_thigh"),
    "chest": ("chest", "left_upper_arm", "right_upper_arm", "neck"),
    "neck": ("neck", "head", "left_upper_arm", "right_upper_arm"),
    "head": ("head", "neck"),
    "upper_arm": ("upper_arm", "forearm"),
    "forearm": ("forearm", "hand"),
    "hand": ("hand",),
    "thigh": ("thigh", "shin"),
    "shin": ("shin", "foot"),
    "foot": ("foot",),
}

_HALF_TURNED: Mapping[str, tuple[str, ...]] = {
    "chest": ("left_upper_arm", "right_upper_arm"),
    "neck": ("left_upper_arm", "right_upper_arm"),
    "upper_arm": ("upper_arm",),
}
"""Joints whose half turns drive a part as well."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PoseExample:
    """One body at rest and posed, body frame, metres; translations are free.

    ``shape`` are the body's coefficients in the shape space that the strengths shall refer to.
    """

    rest: Vertices
    posed: Vertices
    pose: Pose
    shape: Shape


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PoseTerm:
    """The learned term; fields as in :class:`fitter.body.model.BodyModel`."""

    right_hand_sides: Float[np.ndarray, "i 3 nine_q"]
    strengths: Float[np.ndarray, "p nine_q n"]


def pose_feature_joints() -> FeatureJoints:
    """Joints that drive each part's term, half turns after whole ones, -1 where unused."""
    rows: list[list[int]] = []
    for name in PART_NAMES:
        side, limb = side_and_limb(name)
        whole = [_joint(joint, side) for joint in _JOINTS[limb]]
        half = [len(PART_NAMES) + _joint(joint, side) for joint in _HALF_TURNED.get(limb, ())]
        rows.append(whole + half)
    table = np.full((len(rows), max(map(len, rows))), -1, dtype=np.int32)
    for part, row in enumerate(rows):
        table[part, : len(row)] = row
    return table


def _joint(name: str, side: str) -> int:
    return part_index(name if name in PART_NAMES else f"{side}_{name}")


def train_pose_term(
    examples: Iterable[PoseExample],
    laplacians: list[sparse.csr_array],
    parts: Parts,
    joints: FeatureJoints,
    shape_count: int,
    *,
    ridge: float = RIDGE,
) -> PoseTerm:
    """Regress the pose-dependent right-hand sides.

    Parameters
    ----------
    examples
        Bodies in many poses; read once.
    laplacians
        L_p = G_pᵀ W_p G_p of each part on the rest mean mesh.
    parts
        Which vertices each part touches.
    joints
        From :func:`pose_feature_joints`.
    shape_count
        n, the number of coefficients of a shape.
    ridge
        Relative to the mean square of a part's features.
    """
    pointers, vertices = parts.incidence_pointers, parts.incidence_vertices
    spans = [slice(pointers[p], pointers[p + 1]) for p in range(len(laplacians))]
    rows = [laplacian[vertices[span]] for laplacian, span in zip(laplacians, spans, strict=True)]
    used = [9 * int(np.count_nonzero(row >= 0)) for row in joints]
    sums = [
        BilinearSums(feature_count=count, shape_count=shape_count, output_count=3 * row.shape[0])
        for count, row in zip(used, rows, strict=True)
    ]
    for example in examples:
        phi = pose_features(example.pose, joints)
        rotations = global_rotations(example.pose, PART_PARENT)
        for part, laplacian in enumerate(rows):
            target = laplacian @ example.posed @ rotations[part] - laplacian @ example.rest
            sums[part].add(phi[part, : used[part]], example.shape, target.reshape(-1))
    right_hand_sides = np.zeros((len(vertices), 3, 9 * joints.shape[1]))
    strengths = np.zeros((len(joints), 9 * joints.shape[1], shape_count))
    motions = vertex_motions(laplacians, parts)
    for part, span in enumerate(spans):
        solution = solve_bilinear(sums[part], ridge, motions[part])
        linear = solution.linear.reshape(used[part], -1, 3)
        right_hand_sides[span, :, : used[part]] = linear.transpose(1, 2, 0)
        strengths[part, : used[part]] = solution.strengths
    return PoseTerm(right_hand_sides=right_hand_sides, strengths=strengths)


STRIDE = 8
"""Every eighth vertex stands for its neighbours: what is smooth needs no more."""


def vertex_motions(
    laplacians: list[sparse.csr_array], parts: Parts
) -> list[Float[np.ndarray, "_ i"]]:
    """F_p of each part: what an error of a part's right-hand side does to the vertices.

    The mesh is Y = L⁻¹ Σ_p S_p b_p, where S_p scatters the right-hand side b_p of part p. An error
    e of b_p moves the vertices by L⁻¹ S_p e, so its mean square there is |F_p e|² with
    F_p = L⁻¹ S_p / √m. Smooth errors, which add up along a limb, weigh thousands of times more than
    rough ones. The body's translation, which is free, does not count.

    Parameters
    ----------
    laplacians
        L_p = G_pᵀ W_p G_p of each part.
    parts
        Which vertices each part touches.
    """
    count = parts.incidence_vertices.max() + 1
    total = sum(laplacians[1:], start=laplacians[0])
    # Holding one vertex frees the matrix of its null space; right-hand sides sum to zero.
    held = sparse.coo_array(([total.diagonal().mean()], ([0], [0])), shape=(count, count))
    sample = np.arange(0, count, STRIDE)
    chosen = np.zeros((count, len(sample)))
    chosen[sample, np.arange(len(sample))] = 1.0
    rows = splu(sparse.csc_matrix(total + held)).solve(chosen).T
    rows -= rows.mean(axis=0)
    rows /= np.sqrt(len(sample))
    motions: list[np.ndarray] = []
    for part in range(len(laplacians)):
        span = slice(parts.incidence_pointers[part], parts.incidence_pointers[part + 1])
        motions.append(rows[:, parts.incidence_vertices[span]])
    return motions
