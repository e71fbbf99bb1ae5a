"""Stature, and the shape that has a given one (sections 3.1 and 4)."""

import numpy as np

from fitter.arrays import Shape
from fitter.body.scape import ScapeEvaluator
from fitter.errors import NumericalError
from fitter.parameters import BodyParameters

_TOLERANCE_M = 1e-6


def stature_m(evaluator: ScapeEvaluator, shape: Shape) -> float:
    """H(β): vertical extent of the mesh in the standing pose, metres."""
    standing = BodyParameters(
        pose=evaluator.model.standing_pose, translation=np.zeros(3), shape=shape
    )
    heights = evaluator.body_frame_vertices(standing)[:, 1]
    return float(heights.max() - heights.min())


def shape_for_height(evaluator: ScapeEvaluator, height_m: float) -> Shape:
    """The mean person of this gender and height: only the height coefficient is not zero."""
    return shape_with_height(evaluator, np.zeros(len(evaluator.model.shape_basis)), height_m)


def shape_with_height(evaluator: ScapeEvaluator, shape: Shape, height_m: float) -> Shape:
    """The same shape with its height coefficient set so that the stature is ``height_m``.

    Stature is almost linear along the height axis; a few secant steps reach a micrometre.
    """
    adjusted = shape.copy()
    previous = adjusted[0]
    previous_error = stature_m(evaluator, adjusted) - height_m
    adjusted[0] += 1.0
    for _ in range(20):
        error = stature_m(evaluator, adjusted) - height_m
        if abs(error) < _TOLERANCE_M:
            return adjusted
        slope = (error - previous_error) / (adjusted[0] - previous)
        previous, previous_error = adjusted[0], error
        adjusted[0] -= error / slope
    message = f"The height axis of the {evaluator.model.gender} model cannot reach {height_m} m."
    raise NumericalError(message)
