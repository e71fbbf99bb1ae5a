"""The height-preserving shape space at run time (sections 3.1 and 4)."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel, SparseRows, regress
from fitter.body.scape import ScapeEvaluator
from fitter.errors import NumericalError
from fitter.parameters import BodyParameters

_LEAST_SLOPE_M = 1e-6


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

    In a fixed pose vertices are affine in the shape, and so is the stature: two bodies tell all.

    Raises
    ------
    NumericalError
        If the height axis does not change the stature.
    """
    taller = shape.copy()
    taller[0] += 1.0
    height = height_of_shape(evaluator, shape)
    slope = height_of_shape(evaluator, taller) - height
    if not abs(slope) > _LEAST_SLOPE_M:
        message = f"The height axis of the {evaluator.model.gender} model does not change heights."
        raise NumericalError(message)
    adjusted = shape.copy()
    adjusted[0] += (height_m - height) / slope
    return adjusted


def stature_m(standing_vertices: Vertices, landmarks: SparseRows) -> float:
    """Crown above the soles, metres.

    Section 4 measures height on a mesh in a predefined standing pose. Landmarks are fixed weighted
    sums of vertices, so this is linear in the shape where the highest and lowest vertex would not
    be, and one axis of the shape space can carry it exactly.

    Parameters
    ----------
    standing_vertices
        (m, 3) the body in the model's ``standing_pose``, body frame (y up), metres.
    landmarks
        The model's landmark rows, with ``crown``, ``sole_left`` and ``sole_right``.
    """
    heights = regress(landmarks, standing_vertices)[:, 1]
    crown, left, right = (
        float(heights[landmarks.names.index(name)]) for name in ("crown", "sole_left", "sole_right")
    )
    return crown - 0.5 * (left + right)
