"""Linearised residuals: what an energy passes to the Gauss-Newton optimiser.

Each energy that has a least-squares form near the current body returns rows. A row is a residual
r with a weight w, standing for ½ w r², and the derivative of r by the positions of one or more
points of the body (and by a vertex normal, for shading). Robust functions enter as weights
(iteratively reweighted least squares), so that w r ∂r is the energy's own gradient.
"""

from dataclasses import dataclass, replace
from enum import Enum, auto

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points3D
from fitter.body.pose_prior import PriorTerms


class Support(Enum):
    """Points of the body that rows depend on."""

    VERTICES = auto()
    LANDMARKS = auto()
    """Those that were clicked."""
    SPHERES = auto()
    """Spheres of the penetration proxy."""
    JOINTS = auto()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Nuisance:
    """Unknowns that rows have besides the body: the energy takes their most probable values.

    Attributes
    ----------
    name
        Rows whose nuisance has the same name share the unknowns.
    slopes
        (k, u) derivatives of the residuals by the unknowns.
    known
        (r, u) what is known of them besides: rows over their standard deviations.
    held_in_search
        Whether the energy holds them all the same, so that only certainty has to allow for them.
    """

    name: str
    slopes: Float[np.ndarray, "k u"]
    known: Float[np.ndarray, "r u"]
    held_in_search: bool = False


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PositionRows:
    """Residuals that depend on positions; k rows over q points each.

    Attributes
    ----------
    residuals, weights
        (k,) each.
    points
        (k, q) indices into the support.
    derivatives
        (k, q, 3) of the residual by each point's camera-frame position, per metre.
    support
        What the points are.
    nuisance
        Unknowns other than the body's, if the rows have any.
    """

    residuals: Float[np.ndarray, " k"]
    weights: Float[np.ndarray, " k"]
    points: Integer[np.ndarray, "k q"]
    derivatives: Float[np.ndarray, "k q 3"]
    support: Support = Support.VERTICES
    nuisance: Nuisance | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShadingRows:
    """Residuals at single vertices that depend on position and unit normal.

    Attributes
    ----------
    residuals, weights
        (k,) each.
    vertices
        (k,) vertex ids.
    position_derivatives, normal_derivatives
        (k, 3) by camera-frame position (per metre) and by the unit normal.
    centre_derivatives
        (k, 3) by the body's root joint, with which the lamp moves.
    """

    residuals: Float[np.ndarray, " k"]
    weights: Float[np.ndarray, " k"]
    vertices: Integer[np.ndarray, " k"]
    position_derivatives: Points3D
    normal_derivatives: Points3D
    centre_derivatives: Points3D


Rows = PositionRows | ShadingRows | PriorTerms
"""Rows that a term passes on: by points, by vertices and their normals, or by the pose itself."""


def thinned(rows: PositionRows, limit: int) -> PositionRows:
    """At most ``limit`` rows at even steps, reweighted to represent all: enough for the matrix."""
    step = -(-len(rows.residuals) // limit)
    if step <= 1:
        return rows
    chosen = slice(step // 2, None, step)
    nuisance = rows.nuisance
    if nuisance is not None:
        nuisance = replace(nuisance, slopes=nuisance.slopes[chosen])
    return replace(
        rows,
        residuals=rows.residuals[chosen],
        weights=rows.weights[chosen] * step,
        points=rows.points[chosen],
        derivatives=rows.derivatives[chosen],
        nuisance=nuisance,
    )


def geman_mcclure(residuals: Float[np.ndarray, "..."], scale: float) -> Float[np.ndarray, "..."]:
    """ρ_η(x) = x² / (η² + x²), in [0, 1) (section 5, [11])."""
    squared = residuals * residuals
    return squared / (scale * scale + squared)


def geman_mcclure_weights(
    residuals: Float[np.ndarray, "..."], scale: float
) -> Float[np.ndarray, "..."]:
    """Weights w with w x = ρ'_η(x): w = 2 η² / (η² + x²)²."""
    total = scale * scale + residuals * residuals
    return 2.0 * scale * scale / (total * total)


def huber_weights(
    residuals: Float[np.ndarray, "..."], threshold: float
) -> Float[np.ndarray, "..."]:
    """Weights w with w x = the derivative of Huber's function: 1 inside, threshold/|x| outside."""
    return threshold / np.maximum(np.abs(residuals), threshold)


def huber(residuals: Float[np.ndarray, "..."], threshold: float) -> Float[np.ndarray, "..."]:
    """Huber's function: x²/2 within the threshold, linear beyond."""
    size = np.abs(residuals)
    return np.where(size <= threshold, 0.5 * size * size, threshold * (size - 0.5 * threshold))


def boundary_loss(residuals: Float[np.ndarray, "..."], scale: float) -> Float[np.ndarray, "..."]:
    """½ x² / (1 + x²/η²): Geman and McClure's function with unit curvature at zero."""
    squared = residuals * residuals
    return 0.5 * squared / (1.0 + squared / (scale * scale))


def boundary_weights(residuals: Float[np.ndarray, "..."], scale: float) -> Float[np.ndarray, "..."]:
    """Weights w with w x = the derivative of :func:`boundary_loss`."""
    damping = 1.0 + (residuals / scale) ** 2
    return 1.0 / (damping * damping)
