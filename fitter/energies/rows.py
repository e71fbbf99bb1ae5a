"""Linearised residuals: what an energy passes to the Gauss-Newton optimiser.

Each energy that has a least-squares form near the current body returns rows. A row is a residual
r with a weight w, standing for ½ w r², and the derivative of r by the positions of one or more
points of the body (and by a vertex normal, for shading). Robust functions enter as weights
(iteratively reweighted least squares), so that w r ∂r is the energy's own gradient.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points3D


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PositionRows:
    """Residuals that depend on positions; k rows over q points each.

    Attributes
    ----------
    residuals, weights
        (k,) each.
    points
        (k, q) indices into the support: mesh vertices, landmarks or spheres.
    derivatives
        (k, q, 3) of the residual by each point's camera-frame position, per metre.
    of_ease
        Whether the residuals are deviations of the ease of loose clothes from its mean, in pixels
        (:mod:`fitter.energies.ease`).
    """

    residuals: Float[np.ndarray, " k"]
    weights: Float[np.ndarray, " k"]
    points: Integer[np.ndarray, "k q"]
    derivatives: Float[np.ndarray, "k q 3"]
    of_ease: bool = False


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


def thinned(rows: PositionRows, limit: int) -> PositionRows:
    """At most ``limit`` rows at even steps, reweighted to represent all: enough for the matrix."""
    step = -(-len(rows.residuals) // limit)
    if step <= 1:
        return rows
    chosen = slice(step // 2, None, step)
    return replace(
        rows,
        residuals=rows.residuals[chosen],
        weights=rows.weights[chosen] * step,
        points=rows.points[chosen],
        derivatives=rows.derivatives[chosen],
    )
