"""Attribute-preserving shape spaces (section 4), for any attribute a mesh can be measured by.

Starting from G_1 = I, the candidate axis e_k is the one most correlated with the attribute over
the training set. For every other axis e_j the plane (e_j, e_k) is turned so that moving along
e_j keeps the attribute::

    G_j = G_{j-1} R_jk(φ),   φ = argmin ( H(0) - H(G_{j-1} R_jk(φ) e_j) )²

Here φ is where both ends of the axis, three standard deviations out, have the same attribute,
H(3 G R e_j) = H(-3 G R e_j): for stature, which is linear in the shape, that is H(0) itself; for a
weight or a girth it leaves half the change at the worse end that keeping one end alone would.

The coefficients are whitened before (the paper does not say): with equal variances the axis that
collects the attribute is the direction in which bodies of the population differ in it, while
unwhitened it piles up small, unlikely axes and its ends are monsters.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from fitter.arrays import Shape

SOLVED_AT_DEVIATIONS = 3.0
"""φ keeps the attribute this many standard deviations out: the range the paper checks it on."""

Attribute = Callable[[Shape], float]
"""H(β): an attribute of the body of whitened coefficients, measured on its mesh."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AttributeAxes:
    """An orthonormal basis whose first column alone carries an attribute.

    Attributes
    ----------
    rotation
        (n, n) G: old coefficients are G times new ones.
    candidate
        k, the axis the attribute was collected on.
    """

    rotation: Float[np.ndarray, "n n"]
    candidate: int


def attribute_preserving_axes(
    attribute: Attribute,
    coefficients: Float[np.ndarray, "s n"],
    values: Float[np.ndarray, " s"],
    gram: Float[np.ndarray, "n n"],
) -> AttributeAxes:
    """Turn a whitened shape space so that one axis carries an attribute.

    Parameters
    ----------
    attribute
        H(β): measures the body of whitened coefficients.
    coefficients, values
        Training subjects' coefficients and their attribute.
    gram
        Inner products of the displacements along the n axes in the metric of the mesh. They order
        the new axes: after whitening the coefficients' own variances are all one.

    Returns
    -------
    The attribute's axis first, positive toward larger values; then the others, largest first.
    """
    candidate = most_correlated_axis(coefficients, values)
    count = coefficients.shape[1]
    rotation = np.eye(count)
    for axis in range(count):
        if axis != candidate:
            angle = _preserving_angle(attribute, rotation, axis, candidate)
            rotation = rotation @ plane_rotation(count, axis, candidate, angle)
    if attribute(rotation[:, candidate]) < attribute(-rotation[:, candidate]):
        rotation[:, candidate] *= -1.0
    sizes = np.einsum("aj,ab,bj->j", rotation, gram, rotation)
    others = [k for k in np.argsort(-sizes, kind="stable") if k != candidate]
    return AttributeAxes(rotation=rotation[:, [candidate, *others]], candidate=candidate)


def most_correlated_axis(
    coefficients: Float[np.ndarray, "s n"], values: Float[np.ndarray, " s"]
) -> int:
    """Index k of the axis with the largest absolute correlation with an attribute."""
    correlations = [abs(np.corrcoef(column, values)[0, 1]) for column in coefficients.T]
    return int(np.argmax(correlations))


def plane_rotation(count: int, axis: int, candidate: int, angle: float) -> np.ndarray:
    """R_jk(φ): an n x n rotation in the (e_j, e_k) plane."""
    rotation = np.eye(count)
    cosine, sine = np.cos(angle), np.sin(angle)
    rotation[axis, axis], rotation[axis, candidate] = cosine, -sine
    rotation[candidate, axis], rotation[candidate, candidate] = sine, cosine
    return rotation


def attribute_changes(
    attribute: Attribute, axes: Sequence[Shape], deviations: float
) -> Float[np.ndarray, " k"]:
    """Largest change of an attribute at plus and minus some deviations along each axis."""
    still = attribute(np.zeros_like(axes[0]))
    return np.array(
        [
            max(abs(attribute(sign * deviations * axis) - still) for sign in (-1.0, 1.0))
            for axis in axes
        ]
    )


def _preserving_angle(
    attribute: Attribute, rotation: Float[np.ndarray, "n n"], axis: int, candidate: int
) -> float:
    """Solve H(3 G R(φ) e_j) = H(-3 G R(φ) e_j) for φ within a quarter turn.

    R(φ) e_j runs from -e_k over e_j to e_k, which turns the difference of both ends into its
    negative: one root lies between.
    """
    first, second = rotation[:, axis], rotation[:, candidate]

    def difference(angle: float) -> float:
        end = SOLVED_AT_DEVIATIONS * (np.cos(angle) * first + np.sin(angle) * second)
        return attribute(end) - attribute(-end)

    return float(brentq(difference, -np.pi / 2.0, np.pi / 2.0, xtol=1e-10))  # pyright: ignore
