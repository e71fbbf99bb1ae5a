"""The two earlier methods that section 4 compares itself with, measured by how height leaks.

Both are given the same whitened shape space and the same bodies as ours.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.training.shapes.height_rotation import (
    SOLVED_AT_DEVIATIONS,
    Attribute,
    attribute_changes,
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AllenMap:
    """Allen et al.: shape coefficients as a linear function of attributes.

    Attributes
    ----------
    matrix
        (n, a) change of the coefficients by one unit of each attribute.
    constant
        (n,) coefficients where all attributes are zero.
    """

    matrix: Float[np.ndarray, "n a"]
    constant: Float[np.ndarray, " n"]

    def shapes(self, attributes: Float[np.ndarray, "s a"]) -> Float[np.ndarray, "s n"]:
        """Coefficients of the bodies that the attributes describe."""
        return attributes @ self.matrix.T + self.constant


def blanz_vetter_axes(
    coefficients: Float[np.ndarray, "s n"],
    values: Float[np.ndarray, " s"],
    gram: Float[np.ndarray, "n n"],
) -> Float[np.ndarray, "k n"]:
    """Blanz and Vetter: the axis Σ (h_i - h̄) β_i first, then directions orthogonal to it.

    Orthogonal as shapes are, in the metric of the mesh: nothing makes such a direction keep the
    attribute, which is the paper's point. Every row is one standard deviation long.

    Parameters
    ----------
    coefficients, values
        Training subjects' whitened coefficients and their attribute.
    gram
        Inner products of the displacements of the n axes.
    """
    first = (values - values.mean()) @ coefficients
    others = np.delete(np.eye(len(gram)), int(np.argmax(np.abs(first))), axis=0)
    along = others @ gram @ first / (first @ gram @ first)
    axes = np.concatenate([first[None], others - along[:, None] * first])
    return axes / np.linalg.norm(axes, axis=1, keepdims=True)


def allen_map(
    coefficients: Float[np.ndarray, "s n"], attributes: Float[np.ndarray, "s a"]
) -> AllenMap:
    """Least-squares map from attributes to whitened coefficients."""
    extended = np.concatenate([attributes, np.ones((len(attributes), 1))], axis=1)
    solved = np.linalg.lstsq(extended, coefficients, rcond=None)[0].T
    return AllenMap(matrix=solved[:, :-1], constant=solved[:, -1])


def blanz_vetter_leak(
    attribute: Attribute,
    coefficients: Float[np.ndarray, "s n"],
    values: Float[np.ndarray, " s"],
    gram: Float[np.ndarray, "n n"],
) -> float:
    """Largest change of the attribute along an axis that should not carry it, at 3 deviations."""
    axes = blanz_vetter_axes(coefficients, values, gram)
    return float(attribute_changes(attribute, list(axes[1:]), SOLVED_AT_DEVIATIONS).max())


def allen_leak(
    attribute: Attribute,
    mapped: AllenMap,
    attributes: Float[np.ndarray, "s a"],
    kept: int,
) -> float:
    """Largest change of attribute ``kept`` while another moves by 3 deviations, it being held."""
    mean, deviation = attributes.mean(axis=0), attributes.std(axis=0)
    moved = [
        mean + sign * SOLVED_AT_DEVIATIONS * deviation * np.eye(len(mean))[other]
        for other in range(len(mean))
        if other != kept
        for sign in (-1.0, 1.0)
    ]
    still = attribute(mapped.shapes(mean[None])[0])
    return max(abs(attribute(shape) - still) for shape in mapped.shapes(np.stack(moved)))
