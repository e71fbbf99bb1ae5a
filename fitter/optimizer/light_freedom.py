"""The information about the body that shading loses when the light is not held: a Schur complement.

A slightly flatter body under a light slightly farther to the side shows the same brightness. With
the light held, the information matrix M of the body claims to tell the two apart. With body and
light as one vector, marginalising the light leaves M - C L⁻¹ Cᵀ, where L is the light's own block
and C the mixed one.
"""

import numpy as np
from jaxtyping import Float, Integer

from fitter.body.tangent import linearise
from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import ShadingEvidence, shading_rows, thinned_shading
from fitter.optimizer.light_solve import (
    AMBIENT_COLUMNS,
    DISTANCE_SPREAD,
    light_columns,
    surroundings_prior,
)
from fitter.optimizer.normal_equations import MATRIX_SHADING_ROWS
from fitter.optimizer.row_jacobians import shading_row_jacobian
from fitter.render.rasterizer import Rendering
from fitter.render.reflectance import shade_with_derivatives

_RIDGE = 1e-6


def information_lost_to_light(
    objective: Objective, candidate: Candidate, evidence: ShadingEvidence
) -> Float[np.ndarray, "columns columns"]:
    """C L⁻¹ Cᵀ over the full parameter vector, in nats.

    The light's direction and distance, the ambient light or the surroundings, and one scale each
    for albedo and specularity are free, as in :mod:`fitter.optimizer.light_solve`; the rows are
    those of the normal equations, so that the difference stays positive semidefinite.
    """
    evidence = evidence.about(candidate.parameters.translation)
    rows = shading_rows(candidate.rendering, evidence, objective.scales)
    rows = thinned_shading(rows, MATRIX_SHADING_ROWS)
    frame = linearise(objective.operators.tangent, candidate.parameters)
    body = shading_row_jacobian(rows, frame, objective.operators, candidate)
    light = np.sqrt(rows.weights)[:, None] * light_slopes(
        candidate.rendering, evidence, rows.vertices
    )
    own = light.T @ light
    # A directional light has no distance: its column is zero, and the prior keeps L regular.
    own[2, 2] += 1.0 / DISTANCE_SPREAD**2
    if evidence.light.surroundings is not None:
        _, uneven = surroundings_prior(evidence.light.surroundings)
        own[AMBIENT_COLUMNS, AMBIENT_COLUMNS] += uneven.T @ uneven
    own += np.diag(_RIDGE * (own.diagonal() + 1.0))
    mixed = body.T @ light
    return mixed @ np.linalg.solve(own, mixed.T)


def light_slopes(
    rendering: Rendering, evidence: ShadingEvidence, vertices: Integer[np.ndarray, " k"]
) -> Float[np.ndarray, "k columns"]:
    """Derivatives of Eq. 1 at vertices, in the columns of :func:`light_columns`."""
    reflectance = evidence.reflectance_of(vertices)
    slopes = shade_with_derivatives(
        rendering.vertices[vertices],
        rendering.vertex_normals[vertices],
        light=evidence.light,
        body_centre=evidence.body_centre,
        reflectance=reflectance,
        lit=evidence.lit_at(vertices),
    )
    return light_columns(
        slopes,
        evidence.light,
        normals=rendering.vertex_normals[vertices],
        albedo=reflectance.albedo,
        specularity=reflectance.specularity,
    )
