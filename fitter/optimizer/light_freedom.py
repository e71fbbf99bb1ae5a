"""The light as unknowns that shading has besides the body: held in the search, free for certainty.

A slightly flatter body under a light slightly farther to the side shows the same brightness. With
the light held, the information about the body claims to tell the two apart.
"""

import numpy as np
from jaxtyping import Float, Integer

from fitter.energies.objective import Candidate
from fitter.energies.rows import Nuisance, ShadingRows
from fitter.energies.shading import ShadingEvidence
from fitter.optimizer.light_solve import (
    DISTANCE_SPREAD,
    light_columns,
)
from fitter.render.rasterizer import Rendering
from fitter.render.reflectance import shade_with_derivatives

_RIDGE = 1e-6


def light_nuisance(candidate: Candidate, evidence: ShadingEvidence, rows: ShadingRows) -> Nuisance:
    """The light's unknowns in rows of shading, and what is known of them.

    The light's direction and distance, the ambient light, and one scale each
    for albedo and specularity are free, as in :mod:`fitter.optimizer.light_solve`.
    """
    evidence = evidence.about(candidate.parameters.translation)
    slopes = light_slopes(candidate.rendering, evidence, rows.vertices)
    # A directional light has no distance: its column is zero, and this row keeps it regular.
    distance = np.zeros((1, slopes.shape[1]))
    distance[0, 2] = 1.0 / DISTANCE_SPREAD
    diagonal = rows.weights @ slopes**2 + (distance**2).sum(axis=0)
    known = np.concatenate([distance, np.diag(np.sqrt(_RIDGE * (diagonal + 1.0)))])
    return Nuisance(name="light", slopes=slopes, known=known, held_in_search=True)


def light_slopes(
    rendering: Rendering, evidence: ShadingEvidence, vertices: Integer[np.ndarray, " k"]
) -> Float[np.ndarray, "k 6"]:
    """Derivatives of Eq. 1 at vertices, in the columns of :func:`light_columns`."""
    reflectance = evidence.reflectance_of(vertices)
    slopes = shade_with_derivatives(
        rendering.vertices[vertices],
        rendering.vertex_normals[vertices],
        light=evidence.light,
        body_centre=evidence.body_centre,
        reflectance=reflectance,
    )
    return light_columns(
        slopes,
        evidence.light,
        albedo=reflectance.albedo,
        specularity=reflectance.specularity,
    )
