"""The light of the alternation's state: the first one, the next one, and the shadows it casts."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import ShadingEvidence, seen_vertices, usable_vertices
from fitter.evidence.intensity import IntensityMap
from fitter.numerics.mesh_topology import grown
from fitter.optimizer.light_solve import (
    estimate_light,
    first_light,
)
from fitter.optimizer.lit_surface import LightEstimate, LitSurface
from fitter.parameters import Light, Reflectance
from fitter.render.shadow import cast_shadow

SPECULAR_EXPONENT = 12.0
"""α of everybody: skin's gloss. Chosen picture by picture from 6, 12, 24 and 48, it changed with
what nobody sees, and bodies with it, by up to a centimetre."""

_FIRST_LIGHT_WIDENING = 8.0
_LIGHT_WIDENING = 3.0
"""Factors of η₁ for the light: while albedo is uniform, cloth and hair are not outliers to reject
but half of what there is to see. At 1 the first light of two rendered people was 17 and 96 degrees
off; at 8 it was 4 and 6, and nearly the same from every guess."""
_LIGHT_ITERATIONS = 10
_TRIAL_POINTS = 500
"""Points of the surface on which guesses are compared: a light has seven unknowns."""
_PENUMBRA_RINGS = 2
"""Edges of the mesh that a shadow's border may be off, and blurred."""

_LEAST_LIT = 30
# A few vertices lie on hair or cloth or in a fold; this percentile is taken as the darkest skin.
_DARKEST_PERCENTILE = 3.0


def first_state(
    objective: Objective,
    candidate: Candidate,
    intensity: IntensityMap,
    lights: tuple[Light, ...],
) -> ShadingEvidence:
    """The first light, with uniform albedo and specularity (section 5)."""
    m = len(candidate.vertices)
    chosen = seen_vertices(candidate.rendering, intensity)
    observed = intensity.at(candidate.rendering.projected[chosen])
    eta = objective.scales.shading_eta * max(float(np.median(observed)), 1e-3)
    state = ShadingEvidence(
        intensity=intensity,
        light=lights[0],
        body_centre=candidate.parameters.translation,
        reflectance=Reflectance(
            albedo=np.ones(m),
            specularity=np.ones(m),
            ambient=0.0,
            specular_exponent=SPECULAR_EXPONENT,
        ),
        vertex_areas=objective.operators.shaded.areas,
        shadowed=np.zeros(m, dtype=np.bool_),
        eta=eta,
    )
    wide = replace(state, eta=_FIRST_LIGHT_WIDENING * eta)
    surface = _lit_surface(candidate, wide)
    trial = first_light(surface.thinned(_TRIAL_POINTS), lights)
    estimate = estimate_light(surface, trial, iterations=_LIGHT_ITERATIONS)
    return replace(
        state,
        light=estimate.light,
        reflectance=Reflectance(
            albedo=np.full(m, estimate.albedo_scale),
            specularity=np.full(m, estimate.specularity_scale),
            ambient=estimate.ambient,
            specular_exponent=SPECULAR_EXPONENT,
        ),
    )


def with_new_light(candidate: Candidate, state: ShadingEvidence) -> ShadingEvidence:
    """The light that best explains a body with the state's reflectance, up to its scales."""
    surface = _lit_surface(candidate, replace(state, eta=_LIGHT_WIDENING * state.eta))
    found = estimate_light(
        surface,
        LightEstimate(
            light=state.light,
            ambient=state.reflectance.ambient,
            albedo_scale=1.0,
            specularity_scale=1.0,
            energy=1.0,
        ),
        iterations=_LIGHT_ITERATIONS,
    )
    return replace(
        state,
        light=found.light,
        reflectance=replace(
            state.reflectance,
            albedo=found.albedo_scale * state.reflectance.albedo,
            specularity=found.specularity_scale * state.reflectance.specularity,
            ambient=found.ambient,
        ),
    )


def with_new_shadows(
    objective: Objective, candidate: Candidate, state: ShadingEvidence
) -> ShadingEvidence:
    """The state with the vertices in and around the shadows that the light casts on a body.

    If shadows cover everything that is seen, the light is wrong, and they stay as they were.
    """
    shadowed = cast_shadow(
        candidate.vertices,
        objective.operators.model.triangles,
        light=state.light,
        body_centre=state.body_centre,
    )
    edges = objective.operators.topology.edges
    renewed = replace(state, shadowed=grown(shadowed, edges, _PENUMBRA_RINGS))
    left = np.count_nonzero(usable_vertices(candidate.rendering, renewed))
    return renewed if left >= _LEAST_LIT else state


def darkest(observed: Float[np.ndarray, " k"]) -> float:
    """The intensity of the darkest skin among those observed."""
    return float(np.percentile(observed, _DARKEST_PERCENTILE))


def _lit_surface(candidate: Candidate, state: ShadingEvidence) -> LitSurface:
    chosen = np.flatnonzero(usable_vertices(candidate.rendering, state))
    weights = state.vertex_areas[chosen]
    observed = state.intensity.at(candidate.rendering.projected[chosen])
    return LitSurface(
        positions=candidate.rendering.vertices[chosen],
        normals=candidate.rendering.vertex_normals[chosen],
        observed=observed,
        ambient_limit=darkest(observed),
        weights=weights / weights.sum(),
        albedo=state.reflectance.albedo[chosen],
        specularity=state.reflectance.specularity[chosen],
        body_centre=state.body_centre,
        specular_exponent=state.reflectance.specular_exponent,
        eta=state.eta,
    )
