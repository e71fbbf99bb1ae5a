"""A body model in the basis whose first axis alone carries an attribute (section 4)."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.numerics.meshes import enclosed_volume
from fitter.training.shapes.height_rotation import (
    SOLVED_AT_DEVIATIONS,
    Attribute,
    attribute_changes,
    attribute_preserving_axes,
)
from fitter.training.shapes.principal_shapes import centred, vertex_masses


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AttributeSpace:
    """A shape space turned so that one axis carries an attribute.

    Attributes
    ----------
    model
        The same bodies in the new basis: holding coefficient 0 holds the attribute.
    turn
        (n, n) orthonormal: new coefficients are old ones times this.
    """

    model: BodyModel
    turn: Float[np.ndarray, "n n"]


def attribute_space(
    model: BodyModel, attribute: Attribute, coefficients: Float[np.ndarray, "s n"]
) -> AttributeSpace:
    """Turn a model's shape space so that its first axis alone carries an attribute.

    More of the first axis is more of the attribute; more of every other is a fuller body. What the
    model spans, and the prior N(0, I) of its coefficients, stay as they are.

    Parameters
    ----------
    model
        A model with a whitened shape space, in any basis of it.
    attribute
        H(β) in the coefficients of ``model``.
    coefficients
        Bodies of the population, of which the axis most correlated with the attribute is chosen.
    """
    found = attribute_preserving_axes(
        attribute,
        coefficients,
        np.array([attribute(shape) for shape in coefficients]),
        gram_of_axes(model),
    )
    basis = np.tensordot(found.rotation.T, model.shape_basis, axes=1)
    signs = np.array([1.0, *(_fuller_side(model, axis) for axis in basis[1:])])
    turn = found.rotation * signs
    return AttributeSpace(
        model=replace(
            model,
            shape_basis=basis * signs[:, None, None],
            pose_feature_strengths=model.pose_feature_strengths @ turn,
        ),
        turn=turn,
    )


def gram_of_axes(model: BodyModel) -> Float[np.ndarray, "n n"]:
    """Inner products of the axes' displacements, mass centres together, square metres.

    In the metric that shapes are learned in.
    """
    masses = vertex_masses(model.mean_vertices, model.triangles)
    axes = centred(model.shape_basis, masses) * np.sqrt(masses / masses.sum())[:, None]
    flat = axes.reshape(len(axes), -1)
    return flat @ flat.T


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


def blanz_vetter_leak(
    attribute: Attribute,
    coefficients: Float[np.ndarray, "s n"],
    values: Float[np.ndarray, " s"],
    gram: Float[np.ndarray, "n n"],
) -> float:
    """Largest change of the attribute along an axis that should not carry it, at 3 deviations."""
    axes = blanz_vetter_axes(coefficients, values, gram)
    return float(attribute_changes(attribute, list(axes[1:]), SOLVED_AT_DEVIATIONS).max())


def _fuller_side(model: BodyModel, axis: Vertices) -> float:
    """Sign of the direction in which a body gains volume: the axes have none of their own."""
    fuller, thinner = (
        enclosed_volume(model.mean_vertices + sign * axis, model.triangles) for sign in (1.0, -1.0)
    )
    return 1.0 if fuller >= thinner else -1.0
