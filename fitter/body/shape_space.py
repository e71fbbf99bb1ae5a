"""The height-preserving shape space at run time (section 4)."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel


def rest_vertices(model: BodyModel, shape: Shape) -> Vertices:
    """The mesh at rest of a shape, d = U β + μ; body frame, metres."""
    return model.mean_vertices + np.tensordot(shape, model.shape_basis, axes=1)


def rest_combinations(
    model: BodyModel, rows: Float[np.ndarray, "r m"]
) -> tuple[Float[np.ndarray, "r 3"], Float[np.ndarray, "n r 3"]]:
    """Linear combinations of rest vertices as an affine function of the shape.

    Returns the value at the mean and the derivative along each coefficient: limb lengths and
    joints follow a change of shape without touching the mesh (section 3.1).
    """
    mean = rows @ model.mean_vertices
    derivative = np.einsum("rm,nmc->nrc", rows, model.shape_basis, optimize=True)
    return mean, derivative
