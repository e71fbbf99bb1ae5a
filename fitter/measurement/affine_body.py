"""A body in a fixed pose as a function of shape: exact, without evaluating the model again."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Shape, Vertices
from fitter.body.scape import ScapeEvaluator
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AffineBody:
    """A body in one fixed pose as a function of its shape, body frame, metres.

    ``derivative`` has one (m, 3) displacement per coefficient.
    """

    mean: Vertices
    derivative: Float[np.ndarray, "n m 3"]

    def at(self, shape: Shape) -> Vertices:
        """Vertices of the body with this shape."""
        return self.mean + np.tensordot(shape, self.derivative, axes=1)


def affine_body(evaluator: ScapeEvaluator, pose: Pose) -> AffineBody:
    """The body in a fixed pose as an affine function of shape, root joint at the origin.

    Exact: the SCAPE normal equations have a fixed matrix and, the pose being fixed, a right-hand
    side that is affine in the shape.
    """
    n = len(evaluator.model.shape_basis)

    def evaluate(shape: Shape) -> Vertices:
        return evaluator.body_frame_vertices(
            BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
        )

    mean = evaluate(np.zeros(n))
    return AffineBody(mean=mean, derivative=np.stack([evaluate(e) - mean for e in np.eye(n)]))
