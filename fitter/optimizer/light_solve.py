"""First step of the alternation (section 5): the light with body and reflectance held.

The unknowns are azimuth, elevation and distance, the ambient light, and one scale each for albedo
and specularity; without the scales the light would be judged by a reflectance fitted to another.

A slightly flatter body under a light slightly farther to the side shows the same brightness. With
the light held, the information about the body claims to tell the two apart.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Integer

from fitter.energies.objective import Candidate, Objective
from fitter.energies.rows import Nuisance, ShadingRows, geman_mcclure_weights
from fitter.energies.shading import IntensityMap, ShadingEvidence, seen_vertices, usable_vertices
from fitter.numerics.damped_descent import Offer, damped_steps, descend
from fitter.numerics.meshes import grown
from fitter.optimizer.lit_surface import LightEstimate, LightSums, LitSurface
from fitter.parameters import Light, Reflectance
from fitter.render.rasterizer import Rendering
from fitter.render.reflectance import ShadingDerivatives, shade_with_derivatives, shading_terms
from fitter.render.shadow import cast_shadow
from fitter.request import LightGuess
from fitter.vocabulary.choices import LightKind

# Only attenuation across the body tells a light's distance: a weak prior about 3 m, with a spread
# of a factor of two, keeps it from ending inside the body or at infinity.
_USUAL_DISTANCE_M = 3.0
DISTANCE_SPREAD = 0.6
_DISTANCE_RANGE_M = (1.0, 30.0)
_ELEVATION_RANGE = (-1.45, 1.45)
_DISTANCE_PRIOR_WEIGHT = 2e-3

_FIRST_DAMPING = 0.1
_FLOOR = 1e-12
_SETTLED = 2e-4
"""Share of the energy: see :func:`fitter.numerics.damped_descent.descend`."""

# First guesses when the caller gave none: frontal and from both sides, level and from above.
_GUESSED_AZIMUTHS = (-0.9, 0.0, 0.9)
_GUESSED_ELEVATIONS = (0.0, 0.7)
# Each guess is followed for a few steps, and the best of them to the end.
_TRIAL_ITERATIONS, _CONTENDERS, _ITERATIONS = 5, 2, 15


def estimate_light(surface: LitSurface, start: LightEstimate, *, iterations: int) -> LightEstimate:
    """Descend from one light by damped, reweighted Gauss-Newton; the energy never rises.

    ``iterations`` is how many steps are tried at most.
    """
    sums = LightSums(surface)

    def evaluated(estimate: LightEstimate) -> LightEstimate:
        return replace(estimate, energy=sums.energy(estimate) + _prior(estimate))

    def paraboloid(now: LightEstimate) -> Callable[[float], Offer[LightEstimate]]:
        matrix, gradient = _normal_equations(sums, now)
        return damped_steps(
            matrix,
            gradient,
            lambda step: evaluated(_stepped(now, step, surface.ambient_limit)),
            floor=_FLOOR,
        )

    return descend(
        evaluated(start),
        paraboloid,
        max_evaluations=1 + iterations,
        settled=0.0,
        settled_share=_SETTLED,
        first_damping=_FIRST_DAMPING,
    ).point


def _normal_equations(
    sums: LightSums, now: LightEstimate
) -> tuple[Float[np.ndarray, "6 6"], Float[np.ndarray, "6"]]:
    """Those of what is seen, with what is known of lights."""
    matrix, gradient = sums.normal_equations(now)
    if now.light.kind is LightKind.POINT:
        away = np.log(now.light.distance / _USUAL_DISTANCE_M) / DISTANCE_SPREAD**2
        matrix[2, 2] += 2.0 * _DISTANCE_PRIOR_WEIGHT / DISTANCE_SPREAD**2
        gradient[2] += 2.0 * _DISTANCE_PRIOR_WEIGHT * away
    else:
        matrix[2, :] = matrix[:, 2] = 0.0
        matrix[2, 2], gradient[2] = 1.0, 0.0
    return matrix, gradient


def first_light(surface: LitSurface, guesses: tuple[Light, ...]) -> LightEstimate:
    """The best of several first lights, each with its own linear fit of ambient and scales."""
    tried = [
        estimate_light(surface, _with_linear_scales(surface, light), iterations=_TRIAL_ITERATIONS)
        for light in guesses
    ]
    tried.sort(key=lambda estimate: estimate.energy)
    found = [
        estimate_light(surface, estimate, iterations=_ITERATIONS)
        for estimate in tried[:_CONTENDERS]
    ]
    return min(found, key=lambda estimate: estimate.energy)


def guessed_lights(guess: LightGuess) -> tuple[Light, ...]:
    """First lights: the caller's rough guess (section 5), or all around if there is none."""
    distance = float("inf")
    if guess.kind is LightKind.POINT:
        distance = guess.distance or _USUAL_DISTANCE_M
    azimuths = _GUESSED_AZIMUTHS if guess.azimuth is None else (guess.azimuth,)
    elevations = _GUESSED_ELEVATIONS if guess.elevation is None else (guess.elevation,)
    return tuple(
        Light(kind=guess.kind, azimuth=azimuth, elevation=elevation, distance=distance)
        for elevation in elevations
        for azimuth in azimuths
    )


def _with_linear_scales(surface: LitSurface, light: Light) -> LightEstimate:
    """Eq. 1 is linear in ambient and scales: reweighted linear least squares, clipped at zero."""
    estimate = LightEstimate(
        light=light, ambient=0.0, albedo_scale=1.0, specularity_scale=1.0, energy=1.0
    )
    terms = shading_terms(
        surface.positions,
        surface.normals,
        light=light,
        body_centre=surface.body_centre,
        specular_exponent=surface.specular_exponent,
    )
    columns = np.stack(
        [
            np.ones(len(surface.albedo)),
            surface.albedo * terms.diffuse,
            surface.specularity * terms.specular,
        ],
        axis=1,
    )
    weights = surface.weights.copy()
    solution = np.zeros(3)
    for _ in range(8):
        matrix = columns.T @ (weights[:, None] * columns) + 1e-9 * np.eye(3)
        solution = np.maximum(
            np.linalg.solve(matrix, columns.T @ (weights * surface.observed)), 0.0
        )
        residuals = columns @ solution - surface.observed
        weights = surface.weights * geman_mcclure_weights(residuals, surface.eta)
    return replace(
        estimate,
        ambient=min(float(solution[0]), surface.ambient_limit),
        albedo_scale=float(solution[1]),
        specularity_scale=float(solution[2]),
    )


def _prior(estimate: LightEstimate) -> float:
    """The cost of a light before what it lights is seen."""
    if estimate.light.kind is LightKind.DIRECTIONAL:
        return 0.0
    away = np.log(estimate.light.distance / _USUAL_DISTANCE_M) / DISTANCE_SPREAD
    return _DISTANCE_PRIOR_WEIGHT * float(away * away)


def light_columns(
    derivatives: ShadingDerivatives,
    light: Light,
    *,
    albedo: Float[np.ndarray, " k"],
    specularity: Float[np.ndarray, " k"],
) -> Float[np.ndarray, "k 6"]:
    """Derivatives of Eq. 1 by azimuth, elevation, log distance, ambient light and two scales.

    The scales multiply ``albedo`` and ``specularity``; a directional light has no distance, so that
    column is zero.
    """
    point = light.kind is LightKind.POINT
    return np.column_stack(
        [
            derivatives.by_light[:, 0],
            derivatives.by_light[:, 1],
            light.distance * derivatives.by_light[:, 2] if point else np.zeros(len(albedo)),
            np.ones(len(albedo)),
            albedo * derivatives.by_albedo,
            specularity * derivatives.by_specularity,
        ]
    )


def _stepped(
    now: LightEstimate, step: Float[np.ndarray, "6"], ambient_limit: float
) -> LightEstimate:
    light = now.light
    turn = np.clip(step[:2], -0.5, 0.5)
    azimuth = (light.azimuth + turn[0] + np.pi) % (2.0 * np.pi) - np.pi
    elevation = np.clip(light.elevation + turn[1], *_ELEVATION_RANGE)
    distance = light.distance
    if light.kind is LightKind.POINT:
        distance = float(
            np.clip(light.distance * np.exp(np.clip(step[2], -0.7, 0.7)), *_DISTANCE_RANGE_M)
        )
    moved = Light(
        kind=light.kind, azimuth=float(azimuth), elevation=float(elevation), distance=distance
    )
    return LightEstimate(
        light=moved,
        ambient=min(max(now.ambient + float(step[3]), 0.0), ambient_limit),
        albedo_scale=max(now.albedo_scale + float(step[4]), 0.0),
        specularity_scale=max(now.specularity_scale + float(step[5]), 0.0),
        energy=now.energy,
    )


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
