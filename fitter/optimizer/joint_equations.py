"""The normal equations of one shape in one or several pictures, solved by its Schur complement.

The unknowns are the shape β, along the directions that keep what is held, and the pose and place
θ_k in each picture. Pictures meet in the shape alone, so the matrix is

    [ A_1          B_1 ]
    [      ...     ... ]        A_k: θ_k by θ_k,  B_k: θ_k by β,  C: β by β,
    [ B_1ᵀ ...     C   ]

and eliminating every θ_k leaves S = C - Σ_k B_kᵀ A_k⁻¹ B_k for the shape.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.energies.objective import JointCandidate, JointObjective
from fitter.optimizer.free_space import FreeSpace
from fitter.optimizer.normal_equations import normal_equations

_LEAST_CURVATURE = 1e-9


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointEquations:
    """Matrix and gradient by blocks.

    Attributes
    ----------
    own
        A_k, (own, own) of each picture.
    border
        B_k, (own, free).
    shared
        C, (free, free).
    own_gradients, shared_gradient
        (own,) of each picture and (free,).
    directions
        (n, free) of the shape.
    """

    own: tuple[Float[np.ndarray, "own own"], ...]
    border: tuple[Float[np.ndarray, "own free"], ...]
    shared: Float[np.ndarray, "free free"]
    own_gradients: tuple[Float[np.ndarray, " own"], ...]
    shared_gradient: Float[np.ndarray, " free"]
    directions: Float[np.ndarray, "n free"]

    def step(self, damping: float) -> "JointStep":
        """The Gauss-Newton step, with the diagonal raised by a share of itself."""
        shared = _damped(self.shared, damping)
        pull = -self.shared_gradient
        factors = [_damped(matrix, damping) for matrix in self.own]
        back: list[Float[np.ndarray, "own free+1"]] = []
        for matrix, border, gradient in zip(factors, self.border, self.own_gradients, strict=True):
            solved = np.linalg.solve(matrix, np.column_stack([border, -gradient]))
            shared = shared - border.T @ solved[:, :-1]
            pull = pull - border.T @ solved[:, -1]
            back.append(solved)
        shape = np.linalg.solve(shared, pull) if len(pull) else pull
        own = tuple(solved[:, -1] - solved[:, :-1] @ shape for solved in back)
        return JointStep(own=own, shape=shape, promised=self._promised(own, shape))

    def shape_information(self) -> Float[np.ndarray, "free free"]:
        """S: what all say of the shape, poses and places eliminated."""
        information = self.shared
        for matrix, border in zip(self.own, self.border, strict=True):
            information = information - border.T @ np.linalg.solve(matrix, border)
        return information

    def _promised(
        self, own: tuple[Float[np.ndarray, " own"], ...], shape: Float[np.ndarray, " free"]
    ) -> float:
        """The decrease that the undamped paraboloid foretells of a step."""
        change = shape @ (self.shared_gradient + 0.5 * self.shared @ shape)
        for matrix, border, gradient, step in zip(
            self.own, self.border, self.own_gradients, own, strict=True
        ):
            change += step @ (gradient + 0.5 * matrix @ step + border @ shape)
        return -float(change)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointStep:
    """A step: in each picture's own unknowns, along the shape's directions, and what it promises.

    ``promised`` in nats.
    """

    own: tuple[Float[np.ndarray, " own"], ...]
    shape: Float[np.ndarray, " free"]
    promised: float


def joint_equations(
    objective: JointObjective, candidate: JointCandidate, space: FreeSpace
) -> JointEquations:
    """Matrix and gradient of the joint energy at bodies of one shape, in nats.

    ``space`` is what may change of the shape.
    """
    shape, directions = candidate.shape, space.directions
    shared, gradient = objective.shape_equations(shape)
    own: list[Float[np.ndarray, "own own"]] = []
    border: list[Float[np.ndarray, "own free"]] = []
    own_gradients: list[Float[np.ndarray, " own"]] = []
    n = len(shape)
    for view, found in zip(objective.views, candidate.views, strict=True):
        matrix, slope = normal_equations(view, found)
        matrix, slope = objective.weight * matrix, objective.weight * slope
        own.append(matrix[:-n, :-n])
        border.append(matrix[:-n, -n:] @ directions)
        own_gradients.append(slope[:-n])
        shared = shared + matrix[-n:, -n:]
        gradient = gradient + slope[-n:]
    return JointEquations(
        own=tuple(own),
        border=tuple(border),
        shared=directions.T @ shared @ directions,
        own_gradients=tuple(own_gradients),
        shared_gradient=gradient @ directions,
        directions=directions,
    )


def _damped(matrix: Float[np.ndarray, "k k"], damping: float) -> Float[np.ndarray, "k k"]:
    return matrix + np.diag(damping * matrix.diagonal() + _LEAST_CURVATURE)
