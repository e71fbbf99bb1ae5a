"""The height-preserving shape space at run time (sections 3.1 and 4)."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.stature import stature_m
from fitter.errors import NumericalError
from fitter.parameters import BodyParameters

_TOLERANCE_M = 1e-6


def rest_vertices(model: BodyModel, shape: Shape) -> Vertices:
    """The rest mesh of a shape, d = U β + μ; body frame, metres."""
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


def standing_vertices(evaluator: ScapeEvaluator, shape: Shape) -> Vertices:
    """The body in the predefined standing pose θ_H, body frame, metres."""
    return evaluator.body_frame_vertices(
        BodyParameters(pose=evaluator.model.standing_pose, translation=np.zeros(3), shape=shape)
    )


def height_of_shape(evaluator: ScapeEvaluator, shape: Shape) -> float:
    """H(β) of section 4, metres."""
    return stature_m(standing_vertices(evaluator, shape), evaluator.model.landmarks)


def shape_for_height(evaluator: ScapeEvaluator, height_m: float) -> Shape:
    """The mean person of this gender and height: only the height coefficient is not zero."""
    return shape_with_height(evaluator, np.zeros(len(evaluator.model.shape_basis)), height_m)


def shape_with_height(evaluator: ScapeEvaluator, shape: Shape, height_m: float) -> Shape:
    """The same shape with its height coefficient set so that the stature is ``height_m``.

    Stature is almost linear along the height axis; a few secant steps reach a micrometre.

    Raises
    ------
    NumericalError
        If the height axis cannot reach the stature.
    """
    adjusted = shape.copy()
    previous = float(adjusted[0])
    previous_error = height_of_shape(evaluator, adjusted) - height_m
    adjusted[0] += 1.0
    for _ in range(20):
        error = height_of_shape(evaluator, adjusted) - height_m
        if abs(error) < _TOLERANCE_M:
            return adjusted
        slope = (error - previous_error) / (adjusted[0] - previous)
        previous, previous_error = float(adjusted[0]), error
        adjusted[0] -= error / slope
    message = f"The height axis of the {evaluator.model.gender} model cannot reach {height_m} m."
    raise NumericalError(message)
