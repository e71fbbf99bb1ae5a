"""Body shape from shading (section 5): light, reflectance and body in turn.

The smoothness of albedo and specularity starts large and is lowered round by round, so that at
first it is the shape that must change to make the predicted brightness match.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import Vertices
from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import ShadingEvidence, seen_vertices, usable_vertices
from fitter.evidence.intensity import IntensityMap
from fitter.numerics.mesh_parts import grown, mesh_part
from fitter.optimizer.gauss_newton import Minimum
from fitter.optimizer.hidden_reflectance import HiddenVertices
from fitter.optimizer.light_solve import (
    LightEstimate,
    LitSurface,
    estimate_light,
    first_light,
)
from fitter.optimizer.reflectance_solve import (
    ReflectanceFields,
    ReflectanceProblem,
    ReflectanceSolver,
)
from fitter.parameters import BodyParameters, Light, LightKind, Reflectance
from fitter.render.light import light_about
from fitter.render.reflectance import shading_terms
from fitter.render.shadow import cast_shadow

SMOOTHNESS_SCHEDULE = (40.0, 14.0, 5.0)
"""λ₁ = λ₂ of each round, against data weights of mean one a vertex: a step of albedo between two
neighbours costs as much as so many vertices left wholly unexplained. Lower ends (0.3) let the
albedo absorb what the shape should explain; chosen on the evaluation's tuning half."""

REPORTED_SMOOTHNESS = 0.3
"""λ₁ = λ₂ of the reflectance that is reported, when the body no longer moves: at 5 dark cloth may
still be dearer as an edge of albedo than as an error of intensity."""

SPECULAR_EXPONENTS = (6.0, 12.0, 24.0, 48.0)
"""α is chosen from these once, with the first light: skin's broad gloss to a moist shine."""

GRADUATION = ((8.0, 2), (3.0, 2), (1.0, 3))
"""Factors of η₁ and iterations of each reflectance solve. Graduated non-convexity: cloth and hair
are far from the first, uniform albedo, and a narrow robust function would take them for outliers
for ever instead of giving them an albedo of their own."""

REFINEMENT = ((1.0, 3),)
"""The same from a reflectance that was found already."""

# η₂ and η₃ relative to the median albedo: steps larger than this are edges of cloth or hair.
_RELATIVE_ALBEDO_ETA = 0.1
_RELATIVE_SPECULARITY_ETA = 0.1
_FIRST_LIGHT_WIDENING = 8.0
_LIGHT_WIDENING = 3.0
"""Factors of η₁ for the light: while albedo is uniform, cloth and hair are no outliers to be
rejected but half of what there is to see. At 1 the first light of two rendered people was 17 and 96
degrees off, at 8 it was 4 and 6, and nearly the same from every guess."""
_LIGHT_ITERATIONS = 8
_PENUMBRA_RINGS = 2
_MARGIN_RINGS = 3
"""Round what is seen: what a search may bring to sight has an albedo of its own."""
_LEAST_USABLE = 200
# A few vertices lie on hair, cloth or in a fold; this percentile is the darkest skin.
_DARKEST_PERCENTILE = 3.0

BodySearch = Callable[[Objective, BodyParameters], Minimum]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShadedFit:
    """What the alternation found.

    Attributes
    ----------
    minimum
        The body and the energies that were minimised, those of ``evidence``.
    light, reflectance
        In coordinates about the final body's centre, where the light's intensity is 1.
    hidden
        The vertices whose reflectance was not observed but continued.
    evidence
        The shading term of the last round; its light still refers to the centre where the
        alternation began, and its reflectance is smoother than the one reported.
    evaluations
        True energies computed.
    """

    minimum: Minimum
    light: Light
    reflectance: Reflectance
    hidden: HiddenVertices
    evidence: ShadingEvidence
    evaluations: int


def fit_shading(
    objective: Objective,
    start: Candidate,
    intensity: IntensityMap,
    lights: tuple[Light, ...],
    *,
    search: BodySearch,
) -> ShadedFit | None:
    """Minimise E2 from the minimum of E1.

    Parameters
    ----------
    objective
        E1, without shading.
    start
        Its minimum.
    intensity
        The person's luminance.
    lights
        First guesses: one from the caller, or several.
    search
        Minimises an objective over the body from given parameters: the third step.

    Returns
    -------
    None where too few vertices are visible and trusted for shading to say anything.
    """
    if np.count_nonzero(seen_vertices(start.rendering, intensity)) < _LEAST_USABLE:
        return None
    centre = start.parameters.translation
    state = _first_state(objective, start, intensity, lights, centre)
    minimum: Minimum | None = None
    evaluations = 0
    now = start
    for round_index, smoothness in enumerate(SMOOTHNESS_SCHEDULE):
        if round_index > 0:
            state = _with_new_light(now, state)
        state = replace(state, shadowed=_shadowed(objective, now, state))
        state = _with_new_reflectance(
            objective, now, state, smoothness, REFINEMENT if round_index else GRADUATION
        )
        minimum = search(objective.with_shading(state), now.parameters)
        evaluations += minimum.evaluations
        now = minimum.candidate
    assert minimum is not None
    # The reflectance of the final body: what is drawn must be what was found.
    reported = _with_new_reflectance(objective, now, state, REPORTED_SMOOTHNESS, GRADUATION)
    hidden = _hidden(objective, now, reported)
    reflectance = replace(
        reported.reflectance,
        albedo=hidden.filled(reported.reflectance.albedo),
        specularity=hidden.filled(reported.reflectance.specularity),
    )
    light = light_about(state.light, old_centre=centre, new_centre=now.parameters.translation)
    return ShadedFit(
        minimum=minimum,
        light=light,
        reflectance=_at_distance(reflectance, state.light, light),
        hidden=hidden,
        evidence=state,
        evaluations=evaluations,
    )


def _first_state(
    objective: Objective,
    candidate: Candidate,
    intensity: IntensityMap,
    lights: tuple[Light, ...],
    centre: np.ndarray,
) -> ShadingEvidence:
    """The first light, with uniform albedo and specularity (section 5)."""
    m = len(candidate.vertices)
    chosen = seen_vertices(candidate.rendering, intensity)
    observed = intensity.at(candidate.rendering.projected[chosen])
    eta = objective.scales.shading_eta * max(float(np.median(observed)), 1e-3)
    state = ShadingEvidence(
        intensity=intensity,
        light=lights[0],
        body_centre=centre,
        reflectance=Reflectance(
            albedo=np.ones(m), specularity=np.ones(m), ambient=0.0, specular_exponent=1.0
        ),
        vertex_areas=objective.instruments.shaded.areas,
        shadowed=np.zeros(m, dtype=np.bool_),
        eta=eta,
    )
    best: tuple[LightEstimate, float] | None = None
    for exponent in SPECULAR_EXPONENTS:
        surface = _lit_surface(candidate, replace(state, eta=_FIRST_LIGHT_WIDENING * eta), exponent)
        found = first_light(surface, lights if best is None else (best[0].light,))
        if best is None or found.energy < best[0].energy:
            best = found, exponent
    assert best is not None
    estimate, exponent = best
    return replace(
        state,
        light=estimate.light,
        reflectance=Reflectance(
            albedo=np.full(m, estimate.albedo_scale),
            specularity=np.full(m, estimate.specularity_scale),
            ambient=estimate.ambient,
            specular_exponent=exponent,
        ),
    )


def _with_new_light(candidate: Candidate, state: ShadingEvidence) -> ShadingEvidence:
    surface = _lit_surface(
        candidate,
        replace(state, eta=_LIGHT_WIDENING * state.eta),
        state.reflectance.specular_exponent,
    )
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


def _shadowed(
    objective: Objective, candidate: Candidate, state: ShadingEvidence
) -> Bool[np.ndarray, " m"]:
    """Vertices in a cast shadow and round its border, which real lights blur."""
    shadowed = cast_shadow(
        candidate.vertices,
        objective.instruments.model.triangles,
        light=state.light,
        body_centre=state.body_centre,
    )
    return grown(shadowed, objective.instruments.topology.edges, _PENUMBRA_RINGS)


def _with_new_reflectance(
    objective: Objective,
    candidate: Candidate,
    state: ShadingEvidence,
    smoothness: float,
    graduation: tuple[tuple[float, int], ...],
) -> ShadingEvidence:
    rendering, sample = candidate.rendering, objective.instruments.shaded
    usable = usable_vertices(rendering, state)
    part = mesh_part(grown(usable[sample.vertices], sample.edges, _MARGIN_RINGS), sample.edges)
    chosen = sample.vertices[part.vertices]
    seen = usable[chosen]
    intensity = np.zeros(len(chosen))
    intensity[seen] = state.intensity.at(rendering.projected[chosen[seen]])
    weights = np.where(seen, state.vertex_areas[chosen], 0.0)
    weights *= np.count_nonzero(seen) / weights.sum()
    terms = shading_terms(
        rendering.vertices[chosen],
        rendering.vertex_normals[chosen],
        light=state.light,
        body_centre=state.body_centre,
        specular_exponent=state.reflectance.specular_exponent,
    )
    lengths = _edge_lengths(rendering.vertices[sample.vertices], sample.edges)
    albedo_level = max(float(np.median(state.reflectance.albedo[sample.vertices])), 1e-3)
    problem = ReflectanceProblem(
        diffuse=terms.diffuse,
        specular=terms.specular,
        intensity=intensity,
        weights=weights,
        edges=part.edges,
        ambient_limit=_darkest(intensity[seen]),
        edge_lengths=lengths[part.edge_ids],
        albedo_smoothness=smoothness,
        specularity_smoothness=smoothness,
        data_eta=state.eta,
        albedo_eta=_RELATIVE_ALBEDO_ETA * albedo_level,
        specularity_eta=_RELATIVE_SPECULARITY_ETA * albedo_level,
    )
    found = ReflectanceFields(
        albedo=state.reflectance.albedo[chosen],
        specularity=state.reflectance.specularity[chosen],
        ambient=state.reflectance.ambient,
    )
    solver = ReflectanceSolver(part.edges, len(chosen))
    for widening, iterations in graduation:
        # Weights keep the curvatures at zero: only what is far comes to count more.
        wide = replace(
            problem,
            weights=widening**2 * problem.weights,
            albedo_smoothness=widening**2 * problem.albedo_smoothness,
            specularity_smoothness=widening**2 * problem.specularity_smoothness,
            data_eta=widening * problem.data_eta,
            albedo_eta=widening * problem.albedo_eta,
            specularity_eta=widening * problem.specularity_eta,
        )
        found = solver.solve(wide, found, iterations=iterations)
    albedo, specularity = state.reflectance.albedo.copy(), state.reflectance.specularity.copy()
    albedo[chosen], specularity[chosen] = found.albedo, found.specularity
    return replace(
        state,
        reflectance=replace(
            state.reflectance,
            albedo=albedo,
            specularity=specularity,
            ambient=found.ambient,
        ),
    )


def _hidden(objective: Objective, candidate: Candidate, state: ShadingEvidence) -> HiddenVertices:
    """The vertices that took no part in the search for the reflectance."""
    edges = objective.instruments.topology.edges
    lengths = _edge_lengths(candidate.vertices, edges)
    return HiddenVertices.of(usable_vertices(candidate.rendering, state), edges, lengths)


def _edge_lengths(vertices: Vertices, edges: Integer[np.ndarray, "e 2"]) -> Float[np.ndarray, " e"]:
    """Over their mean; no edge counts as shorter than a twentieth of it."""
    first, second = edges.T
    lengths = np.linalg.norm(vertices[first] - vertices[second], axis=1)
    return np.maximum(lengths / lengths.mean(), 0.05)


def _lit_surface(candidate: Candidate, state: ShadingEvidence, exponent: float) -> LitSurface:
    chosen = np.flatnonzero(usable_vertices(candidate.rendering, state))
    weights = state.vertex_areas[chosen]
    observed = state.intensity.at(candidate.rendering.projected[chosen])
    return LitSurface(
        positions=candidate.rendering.vertices[chosen],
        normals=candidate.rendering.vertex_normals[chosen],
        observed=observed,
        ambient_limit=_darkest(observed),
        weights=weights / weights.sum(),
        albedo=state.reflectance.albedo[chosen],
        specularity=state.reflectance.specularity[chosen],
        body_centre=state.body_centre,
        specular_exponent=exponent,
        eta=state.eta,
    )


def _at_distance(reflectance: Reflectance, old: Light, new: Light) -> Reflectance:
    """The same shading when intensity 1 is said of another distance z: a l = a' l'."""
    if old.kind is LightKind.DIRECTIONAL:
        return reflectance
    factor = (old.distance / new.distance) ** 2
    return replace(
        reflectance,
        albedo=factor * reflectance.albedo,
        specularity=factor * reflectance.specularity,
    )


def _darkest(observed: Float[np.ndarray, " k"]) -> float:
    return float(np.percentile(observed, _DARKEST_PERCENTILE))
