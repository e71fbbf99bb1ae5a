"""PCA of registered bodies, in the metric of their vertices (section 3: d = U β + μ)."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PrincipalShapes:
    """Mean and whitened principal axes of a population.

    Attributes
    ----------
    mean
        (m, 3) μ, its mass centre at the origin.
    axes
        (n, m, 3) displacement for one standard deviation along each axis, largest first.
    coefficients
        (subjects, n) of the population, zero mean and unit variance on every axis.
    """

    mean: Vertices
    axes: Float[np.ndarray, "n m 3"]
    coefficients: Float[np.ndarray, "subjects n"]


def centred(meshes: Float[np.ndarray, "s m 3"], masses: PerVertex) -> Float[np.ndarray, "s m 3"]:
    """Meshes moved so that their mass centres lie at the origin.

    Deformation gradients know no position; this is the translation that compares vertices best.
    """
    share = masses / masses.sum()
    return meshes - np.einsum("m,smc->sc", share, meshes)[:, None, :]


def principal_shapes(
    meshes: Float[np.ndarray, "s m 3"], masses: PerVertex, count: int
) -> PrincipalShapes:
    """Principal axes of meshes in one pose.

    Inner products are those of vertex displacements, <x, y> = Σ_i m_i x_i . y_i, not of deformation
    gradients: an error in the gradient of a shin moves the whole foot, which the gradients' own
    metric does not see. Because meshes in one pose and their gradients are linear functions of
    each other, the result is still d = U β + μ, with U stored as vertex displacements.

    Parameters
    ----------
    meshes
        Registered bodies at rest, body frame, metres; any translation.
    masses
        Weight of each vertex: mostly its area, so that the fine mesh of hands and face does not
        decide.
    count
        n, the number of axes kept.
    """
    aligned = centred(meshes, masses)
    mean = aligned.mean(axis=0)
    scaled = (aligned - mean) * np.sqrt(masses / masses.sum())[:, None]
    flat = scaled.reshape(len(meshes), -1)
    _, vectors = np.linalg.eigh(flat @ flat.T / (len(meshes) - 1))
    vectors = vectors[:, ::-1][:, :count]
    # Eigenvectors have no sign of their own; the largest entry decides, so that runs repeat.
    largest = np.argmax(np.abs(vectors), axis=0)
    vectors = vectors * np.sign(vectors[largest, np.arange(count)])
    coefficients = vectors * np.sqrt(len(meshes) - 1)
    displacement = np.einsum("sn,smc->nmc", vectors, aligned - mean, optimize=True)
    return PrincipalShapes(
        mean=mean,
        axes=displacement / np.sqrt(len(meshes) - 1),
        coefficients=coefficients,
    )


def project(
    meshes: Float[np.ndarray, "s m 3"],
    masses: PerVertex,
    mean: Vertices,
    axes: Float[np.ndarray, "n m 3"],
) -> tuple[Float[np.ndarray, "s n"], Float[np.ndarray, "s m 3"]]:
    """Best coefficients of bodies in a shape space, by least squares with translation free.

    Returns
    -------
    coefficients
        (s, n).
    residuals
        (s, m, 3) mesh minus reconstruction, metres, mass centres together.
    """
    weights = np.sqrt(masses / masses.sum())[:, None]
    centred_axes = centred(axes, masses)
    basis = (centred_axes * weights).reshape(len(axes), -1)
    differences = centred(meshes - mean, masses)
    right = (differences * weights).reshape(len(meshes), -1) @ basis.T
    coefficients = np.linalg.solve(basis @ basis.T, right.T).T
    residuals = differences - np.tensordot(coefficients, centred_axes, axes=1)
    return coefficients, residuals
