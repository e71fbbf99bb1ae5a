"""Body shape from shading (section 5): light and reflectance of every picture, and bodies, in turn.

The smoothness of albedo and specularity starts high and is lowered round by round, so that at first
it is the shape that has to change to make the predicted brightness match.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Vertices
from fitter.energies.objective import Candidate, JointCandidate, JointObjective, Objective
from fitter.energies.shading import IntensityMap, ShadingEvidence, seen_vertices, usable_vertices
from fitter.numerics.meshes import grown, mesh_part
from fitter.numerics.surface_sample import SurfaceSample
from fitter.optimizer.hidden_reflectance import HiddenVertices
from fitter.optimizer.light_solve import (
    darkest,
    first_state,
    with_new_light,
    with_new_shadows,
)
from fitter.optimizer.reflectance_solve import (
    ReflectanceFields,
    ReflectanceProblem,
    ReflectanceSolver,
)
from fitter.optimizer.search import BodySearch, Minimum
from fitter.parameters import Light, Reflectance
from fitter.render.rasterizer import render
from fitter.render.reflectance import shading_terms

SMOOTHNESS_SCHEDULE = (40.0, 14.0, 5.0)
"""λ₁ = λ₂ of each round, relative to data weights with a mean of one per vertex: a step of albedo
between two neighbours costs as much as this many vertices left wholly unexplained. With a lower
last value (0.3) the albedo absorbs what the shape should explain; chosen on the evaluation's tuning
half."""

REPORTED_SMOOTHNESS = 0.3
"""λ₁ = λ₂ of the reflectance that is reported, once the body no longer moves: at 5, dark cloth may
still cost more as an edge of albedo than as an error of intensity."""

GRADUATION = ((8.0, 2), (3.0, 2), (1.0, 2))
"""Factors of η₁ and iterations of each reflectance solve. Graduated non-convexity: cloth and hair
are far from the first, uniform albedo, and a narrow robust function would treat them as outliers
for good instead of giving them an albedo of their own."""

REPORTED_GRADUATION = ((8.0, 2), (3.0, 2), (1.0, 3))
"""The same of the reflectance that is reported: after two at the last width, half of a pair of dark
trunks was still grey. The body's search does not mind."""

REFINEMENT = ((1.0, 2),)
"""The same, starting from a reflectance already found."""

# η₂ and η₃ relative to the median albedo: larger steps than this are edges of cloth or hair.
_RELATIVE_ALBEDO_ETA = 0.1
_RELATIVE_SPECULARITY_ETA = 0.1
_MARGIN_RINGS = 3
"""Rings of vertices around those seen that get an albedo too: a search may bring them into view."""

_LEAST_USABLE = 200

Round = tuple[float, BodySearch]
"""λ₁ = λ₂, and the search for the bodies."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Alternated:
    """End of the alternation.

    Attributes
    ----------
    minimum
        Of E2.
    states
        The shading term of each picture in the last round; None where it has none.
    evaluations
        True energies computed.
    """

    minimum: Minimum
    states: tuple[ShadingEvidence | None, ...]
    evaluations: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShadedFit:
    """Light and reflectance that the alternation found in one picture.

    Attributes
    ----------
    body
        The final body on all of its vertices: what light and reflectance are reported on.
    light, reflectance
        In coordinates about the final body's centre, where the light's intensity is 1.
    hidden
        The vertices whose reflectance was not observed but filled in.
    evidence
        The shading term of the last round; its reflectance is smoother than the one reported.
    """

    body: Candidate
    light: Light
    reflectance: Reflectance
    hidden: HiddenVertices
    evidence: ShadingEvidence


def fit_shading(
    objective: JointObjective,
    start: JointCandidate,
    states: Sequence[ShadingEvidence | None],
    rounds: Sequence[Round],
) -> Alternated:
    """Minimise E2 from the minimum of E1.

    Parameters
    ----------
    objective
        E1, without shading.
    start
        Its minimum.
    states
        The first light in each picture (:func:`first_shading`); None where shading takes no part.
    rounds
        One at least: light and reflectance of every picture, then the bodies.
    """
    now, evaluations = start, 0
    minimum: Minimum | None = None
    for number, (smoothness, search) in enumerate(rounds):
        states = [
            None
            if state is None
            else next_shading(view, seen, state, smoothness=smoothness, light_is_new=number == 0)
            for view, seen, state in zip(objective.views, now.views, states, strict=True)
        ]
        minimum = search(with_shading(objective, states), now.views)
        evaluations += minimum.evaluations
        now = minimum.candidate
    assert minimum is not None
    return Alternated(minimum=minimum, states=tuple(states), evaluations=evaluations)


def with_shading(
    objective: JointObjective, states: Sequence[ShadingEvidence | None]
) -> JointObjective:
    """E1 with the shading term of each picture that has one: E2."""
    return objective.with_views(
        [
            view if state is None else view.with_shading(state)
            for view, state in zip(objective.views, states, strict=True)
        ]
    )


def first_shading(
    objective: Objective,
    start: Candidate,
    intensity: IntensityMap,
    lights: tuple[Light, ...],
) -> ShadingEvidence | None:
    """The first light on the minimum of E1; None if too little is seen to tell anything."""
    if np.count_nonzero(seen_vertices(start.rendering, intensity)) < _LEAST_USABLE:
        return None
    return first_state(objective, start, intensity, lights)


def next_shading(
    objective: Objective,
    now: Candidate,
    state: ShadingEvidence,
    *,
    smoothness: float,
    light_is_new: bool,
) -> ShadingEvidence:
    """Light, shadows and reflectance of a body: what a round does before the body moves."""
    state = state.about(now.parameters.translation)
    if not light_is_new:
        state = with_new_light(now, state)
    state = with_new_shadows(objective, now, state)
    return _with_new_reflectance(
        objective, now, state, smoothness, GRADUATION if light_is_new else REFINEMENT
    )


def shaded_fit(objective: Objective, final: Candidate, state: ShadingEvidence) -> ShadedFit:
    """Light and reflectance that are reported of a picture once the body no longer moves.

    The reflectance is found again for the final body, so that what is drawn is what was found.
    """
    state = state.about(final.parameters.translation)
    objective, now, reported = on_whole_body(objective, final, state)
    reported = _with_new_reflectance(
        objective, now, reported, REPORTED_SMOOTHNESS, REPORTED_GRADUATION
    )
    hidden = _hidden(objective, now, reported)
    reflectance = replace(
        reported.reflectance,
        albedo=hidden.filled(reported.reflectance.albedo),
        specularity=hidden.filled(reported.reflectance.specularity),
    )
    return ShadedFit(
        body=now,
        light=reported.light,
        reflectance=reflectance,
        hidden=hidden,
        evidence=state,
    )


def _with_new_reflectance(
    objective: Objective,
    candidate: Candidate,
    state: ShadingEvidence,
    smoothness: float,
    graduation: tuple[tuple[float, int], ...],
) -> ShadingEvidence:
    rendering, sample = candidate.rendering, objective.operators.shaded
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
        ambient_limit=darkest(intensity[seen]),
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
    solver = ReflectanceSolver(part.edges, _order_within(sample, part.vertices))
    for widening, iterations in graduation:
        # The weights keep their curvature at zero: only what is far off comes to count more.
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


def _order_within(
    sample: SurfaceSample, vertices: Integer[np.ndarray, " v"]
) -> Integer[np.ndarray, " v"]:
    """Some vertices of a sample in the sample's order of elimination, numbered among themselves."""
    return np.argsort(sample.elimination_ranks[vertices])


def _hidden(objective: Objective, candidate: Candidate, state: ShadingEvidence) -> HiddenVertices:
    """The vertices that took no part in the search for the reflectance."""
    edges = objective.operators.topology.edges
    lengths = _edge_lengths(candidate.vertices, edges)
    return HiddenVertices.of(usable_vertices(candidate.rendering, state), edges, lengths)


def _edge_lengths(vertices: Vertices, edges: Integer[np.ndarray, "e 2"]) -> Float[np.ndarray, " e"]:
    """Edge lengths divided by their mean; none counts as shorter than a twentieth of it."""
    first, second = edges.T
    lengths = np.linalg.norm(vertices[first] - vertices[second], axis=1)
    return np.maximum(lengths / lengths.mean(), 0.05)


def on_whole_body(
    objective: Objective, candidate: Candidate, state: ShadingEvidence
) -> tuple[Objective, Candidate, ShadingEvidence]:
    """The same body on all of its vertices, with the objective's operators and the shading state.

    Vertices that the search left out have no area: they take no part, and are filled in at the
    end. Of the objective and the candidate only what shading reads is exchanged: operators,
    vertices and rendering. Where the search was on the whole body, all is returned as it is.
    """
    whole = objective.operators.whole
    if whole is None:
        return objective, candidate, state
    lifted = whole.lighter.lifted
    vertices = whole.operators.evaluator.vertices(candidate.parameters)
    rendering = render(vertices, whole.operators.model.triangles, candidate.rendering.camera)
    return (
        replace(objective, operators=whole.operators),
        replace(candidate, vertices=vertices, rendering=rendering),
        replace(
            state,
            reflectance=replace(
                state.reflectance,
                albedo=lifted(state.reflectance.albedo),
                specularity=lifted(state.reflectance.specularity),
            ),
            vertex_areas=whole.operators.shaded.areas,
            shadowed=lifted(state.shadowed),
        ),
    )
