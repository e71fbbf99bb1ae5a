"""The bodies of a motion as one body and a few morph targets.

The frames of a motion span far fewer dimensions than there are frames. With the first frame's body
X_0, target shapes B and weights w, X_t = X_0 + Σ_k w_tk B_k; the targets are the principal ones of
X_t - X_0, so for their number none leave less. Every frame keeps its own time: nothing is thinned
out and interpolated. Three strides of walking need 12 targets for 0.4 mm, eight seconds of a dance
64 for 7 mm in the worst vertex of the worst frame, and 0.4 mm on average.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

MOST_TARGETS = 64

ERROR_GOAL_M = 0.003
"""In the worst vertex of the worst frame: as many targets are taken as it needs, up to the most."""

_LEAST_SHARE = 1e-12
"""Of the largest variance: what is smaller is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PrincipalFrames:
    """The bodies of a motion in a basis.

    Attributes
    ----------
    base
        (m, 3) the first body, metres.
    targets
        (k, m, 3) displacements at weight one, metres.
    weights
        (t, k) within [-1, 1]; zero in the first frame.
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
    frames, m, _ = shapes.shape
    moves = (shapes - shapes[0]).reshape(frames, -1)
    variances, vectors = np.linalg.eigh(np.asarray(moves @ moves.T, dtype=np.float64))
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
    weights, chosen = vectors[:, :many], targets[:many]
    weights = weights - weights[:1]
    largest = np.maximum(np.abs(weights).max(axis=0), 1e-30).astype(np.float32)
    return PrincipalFrames(
        base=shapes[0],
        targets=(chosen * largest[:, None]).reshape(-1, m, 3),
        weights=weights / largest,
        largest_error_m=float(errors.max()),
        mean_error_m=float(errors.mean()),
    )


def _errors(
    moves: Float32[np.ndarray, "t three_m"],
    vectors: Float32[np.ndarray, "t k"],
    targets: Float32[np.ndarray, "k three_m"],
    count: int,
) -> Float32[np.ndarray, "t m"]:
    """Distance of every vertex in every frame, with ``count`` targets and none in the first."""
    weights = vectors[:, :count] - vectors[:1, :count]
    # Frame by frame: all at once would take the memory of the motion once more.
    return np.stack(
        [
            np.linalg.norm((move - weight @ targets[:count]).reshape(-1, 3), axis=1)
            for move, weight in zip(moves, weights, strict=True)
        ]
    )
