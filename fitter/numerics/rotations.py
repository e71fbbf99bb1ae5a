"""Rotation vectors and matrices.

Own formulas rather than SciPy's ``Rotation``: the body model turns 17 parts about a thousand
times a fit, and building the objects costs more than the evaluation itself.
"""

import numpy as np
from jaxtyping import Float

from fitter.numerics._rotation_kernels import rodrigues

_SMALL_ANGLE = 1e-8


def rotation_matrices(vectors: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "k 3 3"]:
    """Rotation matrices of rotation vectors (radians), by Rodrigues' formula.

    R = I + sin(t)/t K + (1 - cos(t))/t² K², with K the cross-product matrix and t the angle.
    """
    vectors = np.asarray(vectors, dtype=np.float64)
    matrices = np.empty((len(vectors), 3, 3))
    rodrigues(vectors, _SMALL_ANGLE, matrices)
    return matrices


def cross_product_matrices(vectors: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "k 3 3"]:
    """Matrices K with K x = v × x."""
    matrices = np.zeros((len(vectors), 3, 3))
    matrices[:, 0, 1] = -vectors[:, 2]
    matrices[:, 0, 2] = vectors[:, 1]
    matrices[:, 1, 0] = vectors[:, 2]
    matrices[:, 1, 2] = -vectors[:, 0]
    matrices[:, 2, 0] = -vectors[:, 1]
    matrices[:, 2, 1] = vectors[:, 0]
    return matrices


def rotation_vectors(matrices: Float[np.ndarray, "k 3 3"]) -> Float[np.ndarray, "k 3"]:
    """Rotation vectors of rotation matrices, angles in [0, π].

    Goes through the unit quaternion by its largest component, which stays accurate near π where
    the antisymmetric part vanishes.
    """
    matrices = np.asarray(matrices, dtype=np.float64)
    diagonal = np.einsum("kii->ki", matrices)
    trace = diagonal.sum(axis=1)
    # Row r of `candidates` is 4 q_r q, for the component r of the quaternion (w, x, y, z).
    candidates = np.empty((len(matrices), 4, 4))
    candidates[:, 0, 0] = 1.0 + trace
    for axis in range(3):
        candidates[:, axis + 1, axis + 1] = 1.0 - trace + 2.0 * diagonal[:, axis]
        after, last = (axis + 1) % 3, (axis + 2) % 3
        antisymmetric = matrices[:, last, after] - matrices[:, after, last]
        candidates[:, 0, axis + 1] = candidates[:, axis + 1, 0] = antisymmetric
        symmetric = matrices[:, axis, after] + matrices[:, after, axis]
        candidates[:, axis + 1, after + 1] = candidates[:, after + 1, axis + 1] = symmetric
    largest = np.argmax(np.einsum("krr->kr", candidates), axis=1)
    quaternion = candidates[np.arange(len(matrices)), largest]
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    quaternion = np.where(quaternion[:, :1] < 0.0, -quaternion, quaternion)
    imaginary = np.linalg.norm(quaternion[:, 1:], axis=1)
    angle = 2.0 * np.arctan2(imaginary, quaternion[:, 0])
    small = imaginary < _SMALL_ANGLE
    factor = np.where(small, 2.0, angle / np.where(small, 1.0, imaginary))
    return quaternion[:, 1:] * factor[:, None]


def compose(
    first: Float[np.ndarray, "k 3"], second: Float[np.ndarray, "k 3"]
) -> Float[np.ndarray, "k 3"]:
    """Rotation vectors of exp(first) exp(second)."""
    return rotation_vectors(np.matmul(rotation_matrices(first), rotation_matrices(second)))
