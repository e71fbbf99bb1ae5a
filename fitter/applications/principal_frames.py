"""The bodies of a motion as one body and a few morph targets.

The frames of a motion span far fewer dimensions than there are frames. With the first frame's body
X_0, target shapes B and weights w, X_t = X_0 + Σ_k w_tk B_k; the targets are the principal ones of
X_t - X_0, so for their number none leave less. Every frame keeps its own time: nothing is thinned
out and interpolated. Three strides of walking need 10 targets for 1.1 mm in the worst vertex of the
worst frame and 0.07 mm on average, eight seconds of a dance 64 for 7 mm and 0.4 mm.

Programs clamp morph weights to [0, 1] (Blender's shape keys do). So each weight is measured from
its lowest value, and one more target, always at weight 1, takes the lowest values' sum back:
X_0 stays the base, for readers that know no targets.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32

MOST_TARGETS = 64

ERROR_GOAL_M = 0.003
"""In the worst vertex of the worst frame: as many targets are taken as it needs, up to the most."""

_LEAST_SHARE = 1e-12
"""Share of the largest variance below which a variance is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PrincipalFrames:
    """The bodies of a motion in a basis.

    Attributes
    ----------
    base
        (m, 3) the first body, metres.
    targets
        (k + 1, m, 3) displacements at weight one, metres; the last cancels the others in the first
        frame.
    weights
        (t, k + 1) within [0, 1]; the last is 1 in every frame.
    largest_error_m, mean_error_m
        Distance of vertices from the exact ones, over all frames.
    """

    base: Float32[np.ndarray, "m 3"]
    targets: Float32[np.ndarray, "k m 3"]
    weights: Float32[np.ndarray, "t k"]
    largest_error_m: float
    mean_error_m: float


def principal_frames(shapes: Float32[np.ndarray, "t m 3"]) -> PrincipalFrames:
    """The basis of the fewest targets that reach the goal, or of the most there may be."""
    moves = (shapes - shapes[0]).reshape(len(shapes), -1)
    variances, vectors = np.linalg.eigh((moves @ moves.T).astype(np.float64))
    order = np.argsort(variances)[::-1]
    # Of a body that does not move one target is left, which does nothing: there must be one.
    order = order[: max(int((variances[order] > _LEAST_SHARE * variances.max()).sum()), 1)]
    vectors = vectors[:, order[:MOST_TARGETS]].astype(np.float32)
    targets = vectors.T @ moves
    few, many = 1, len(targets)
    # Errors fall with every target in the mean; in the worst vertex all but surely.
    while few < many:
        middle = (few + many) // 2
        if _errors(moves, vectors, targets, middle).max() <= ERROR_GOAL_M:
            many = middle
        else:
            few = middle + 1
    errors = _errors(moves, vectors, targets, many)
    lowest = vectors[:, :many].min(axis=0)
    span = np.maximum(vectors[:, :many].max(axis=0) - lowest, 1e-30)
    weights = np.clip((vectors[:, :many] - lowest) / span, 0.0, 1.0)
    return PrincipalFrames(
        base=shapes[0],
        targets=with_rest(targets[:many] * span[:, None], weights[0]).reshape(-1, *shapes[0].shape),
        weights=np.column_stack([weights, np.ones(len(weights), dtype=np.float32)]),
        largest_error_m=float(errors.max()),
        mean_error_m=float(errors.mean()),
    )


def with_rest(
    targets: Float[np.ndarray, " k *rest"], weights: Float[np.ndarray, " k"]
) -> Float[np.ndarray, " k_and_one *rest"]:
    """Append the target that, at weight one, cancels the others at these weights."""
    return np.concatenate([targets, -np.tensordot(weights, targets, axes=1)[None]])


def _errors(
    moves: Float32[np.ndarray, "t three_m"],
    vectors: Float32[np.ndarray, "t k"],
    targets: Float32[np.ndarray, "k three_m"],
    count: int,
) -> Float32[np.ndarray, "t m"]:
    """Distance of each vertex in every frame, with ``count`` targets."""
    left = moves - (vectors[:, :count] - vectors[:1, :count]) @ targets[:count]
    return np.linalg.norm(left.reshape(len(moves), -1, 3), axis=2)
