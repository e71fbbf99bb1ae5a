"""Linear and dual-quaternion blend skinning."""

import numpy as np
from jaxtyping import Float
from scipy import sparse

from fitter.arrays import Rotations, Vertices
from fitter.numerics.rotations import rotation_vectors


def blend_linear(
    skin: sparse.csr_array,
    rotations: Rotations,
    translations: Float[np.ndarray, "b 3"],
    rest: Vertices,
) -> Vertices:
    """Weighted mean of the bones' rigid motions of each vertex."""
    transforms = np.concatenate([rotations, translations[:, :, None]], axis=2).reshape(-1, 12)
    blended = (skin @ transforms).reshape(-1, 3, 4)
    return np.einsum("mij,mj->mi", blended[:, :, :3], rest) + blended[:, :, 3]


def blend_dual_quaternion(
    skin: sparse.csr_array,
    rotations: Rotations,
    translations: Float[np.ndarray, "b 3"],
    rest: Vertices,
) -> Vertices:
    """Dual-quaternion skinning (Kavan et al. 2007): the blend of rigid motions stays rigid."""
    real = _quaternions(rotations)
    pure = np.concatenate([np.zeros((len(real), 1)), translations], axis=1)
    dual = 0.5 * _product(pure, real)
    rows = np.repeat(np.arange(len(skin.indptr) - 1), np.diff(skin.indptr))
    # q and -q are one rotation; each vertex takes the signs that agree with its heaviest bone.
    pivot = real[_heaviest(skin)]
    sign = np.where(np.einsum("zi,zi->z", real[skin.indices], pivot[rows]) < 0.0, -1.0, 1.0)
    signed = sparse.csr_array((skin.data * sign, skin.indices, skin.indptr), shape=skin.shape)
    blended_real, blended_dual = signed @ real, signed @ dual
    norm = np.linalg.norm(blended_real, axis=1, keepdims=True)
    blended_real, blended_dual = blended_real / norm, blended_dual / norm
    conjugate = blended_real * np.array([1.0, -1.0, -1.0, -1.0])
    translation = 2.0 * _product(blended_dual, conjugate)[:, 1:]
    scalar, vector = blended_real[:, :1], blended_real[:, 1:]
    turned = rest + 2.0 * np.cross(vector, np.cross(vector, rest) + scalar * rest)
    return turned + translation


def blend_half_dual_quaternion(
    skin: sparse.csr_array,
    rotations: Rotations,
    translations: Float[np.ndarray, "b 3"],
    rest: Vertices,
) -> Vertices:
    """Mean of the two."""
    linear = blend_linear(skin, rotations, translations, rest)
    return 0.5 * (linear + blend_dual_quaternion(skin, rotations, translations, rest))


def _quaternions(rotations: Rotations) -> Float[np.ndarray, "b 4"]:
    vectors = rotation_vectors(rotations)
    angle = np.linalg.norm(vectors, axis=1)
    half_sine = 0.5 * np.sinc(0.5 * angle / np.pi)
    return np.concatenate([np.cos(angle / 2.0)[:, None], half_sine[:, None] * vectors], axis=1)


def _product(
    first: Float[np.ndarray, "k 4"], second: Float[np.ndarray, "k 4"]
) -> Float[np.ndarray, "k 4"]:
    scalar = first[:, 0] * second[:, 0] - np.einsum("ki,ki->k", first[:, 1:], second[:, 1:])
    vector = (
        first[:, :1] * second[:, 1:]
        + second[:, :1] * first[:, 1:]
        + np.cross(first[:, 1:], second[:, 1:])
    )
    return np.concatenate([scalar[:, None], vector], axis=1)


def _heaviest(skin: sparse.csr_array) -> np.ndarray:
    starts = skin.indptr[:-1]
    largest = np.maximum.reduceat(skin.data, starts)
    rows = np.repeat(np.arange(len(skin.indptr) - 1), np.diff(skin.indptr))
    at_largest = np.flatnonzero(skin.data == largest[rows])
    first = np.searchsorted(rows[at_largest], np.arange(len(skin.indptr) - 1))
    return skin.indices[at_largest[first]]
