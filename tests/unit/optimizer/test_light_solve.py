"""The compiled sums of the search for the light beside Eq. 1 and its derivatives point by point."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.objective import Body, Candidate, JointObjective, Objective
from fitter.energies.rows import geman_mcclure, geman_mcclure_weights
from fitter.energies.shading import IntensityMap, ShadingEvidence, seen_vertices, usable_vertices
from fitter.optimizer.light_solve import first_state, light_columns, light_slopes, with_new_shadows
from fitter.optimizer.lit_surface import LightEstimate, LightSums, LitSurface
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.search import Minimum
from fitter.optimizer.uncertainty import certainty, shape_covariance
from fitter.parameters import Light, Reflectance
from fitter.render.reflectance import shade, shade_with_derivatives
from fitter.render.shadow import cast_shadow
from fitter.vocabulary.choices import LightKind
from tests.unit.optimizer.rendered_scene import (
    LIGHT,
    RenderedScene,
    lit_fit,
    of_person,
    rendered_scene,
)


@pytest.mark.parametrize("kind", list(LightKind))
def test_sums_are_those_of_the_points(kind):
    rng = np.random.default_rng(9)
    count = 60
    normals = rng.normal(size=(count, 3)) - [0.0, 0.0, 0.5]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    weights = rng.uniform(size=count)
    surface = LitSurface(
        positions=rng.normal(size=(count, 3)) * 0.3 + [0.0, 0.0, 3.0],
        normals=normals,
        observed=rng.uniform(0.0, 0.6, count),
        weights=weights / weights.sum(),
        albedo=rng.uniform(0.2, 0.6, count),
        specularity=rng.uniform(0.0, 0.3, count),
        ambient_limit=0.3,
        body_centre=np.array([0.1, 0.0, 3.0]),
        specular_exponent=12.0,
        eta=0.2,
    )
    light = Light(
        kind=kind,
        azimuth=0.4,
        elevation=0.3,
        distance=2.5 if kind is LightKind.POINT else float("inf"),
    )
    estimate = LightEstimate(
        light=light,
        ambient=0.05,
        albedo_scale=0.9,
        specularity_scale=1.3,
        energy=1.0,
    )
    derivatives = shade_with_derivatives(
        surface.positions,
        normals,
        light=light,
        body_centre=surface.body_centre,
        reflectance=Reflectance(
            albedo=0.9 * surface.albedo,
            specularity=1.3 * surface.specularity,
            ambient=estimate.ambient,
            specular_exponent=12.0,
        ),
    )
    residuals = derivatives.shading - surface.observed
    columns = light_columns(
        derivatives,
        light,
        albedo=surface.albedo,
        specularity=surface.specularity,
    )
    reweighted = (surface.weights * geman_mcclure_weights(residuals, surface.eta))[:, None]
    sums = LightSums(surface)
    energy = surface.weights @ geman_mcclure(residuals, surface.eta)
    assert sums.energy(estimate) == pytest.approx(energy, rel=1e-12)
    matrix, gradient = sums.normal_equations(estimate)
    np.testing.assert_allclose(matrix, columns.T @ (reweighted * columns), atol=1e-12)
    np.testing.assert_allclose(gradient, columns.T @ (reweighted[:, 0] * residuals), atol=1e-12)


def as_it_is(objective: JointObjective, bodies: Sequence[Body]) -> Minimum:
    """A search that finds nothing better."""
    return Minimum(candidate=objective.evaluate(bodies), converged=True, evaluations=1)


def seeing_only(scene: RenderedScene, chosen: np.ndarray) -> IntensityMap:
    """The picture, of which no more is trusted than the pixels of some vertices."""
    rendering = scene.objective.evaluate(scene.truth).rendering
    seen = seen_vertices(rendering, scene.intensity)
    counts = [np.zeros(scene.intensity.trusted.shape, dtype=np.int64) for _ in range(2)]
    for count, vertices in zip(counts, (chosen, ~chosen), strict=True):
        columns, rows = np.floor(rendering.projected[vertices & seen]).astype(int).T
        np.add.at(count, (rows, columns), 1)
    only = (counts[0] > 0) & (counts[1] == 0)
    return replace(scene.intensity, trusted=scene.intensity.trusted & only)


def test_a_light_whose_shadows_hide_all_there_is_to_see_is_not_believed():
    high = replace(LIGHT, azimuth=0.0, elevation=1.2)
    dark = rendered_scene(1, high)
    candidate = dark.objective.evaluate(dark.truth)
    triangles = dark.operators.model.triangles
    centre = dark.truth.translation
    hidden = cast_shadow(candidate.vertices, triangles, light=high, body_centre=centre)
    seen = seen_vertices(candidate.rendering, dark.intensity)
    intensity = seeing_only(dark, hidden & seen)
    state = first_state(dark.objective, candidate, intensity, (high,))
    lit = replace(state, light=high)
    kept = with_new_shadows(dark.objective, candidate, lit)
    assert usable_vertices(candidate.rendering, kept).any()
    found = lit_fit(dark, candidate, as_it_is, (high,), intensity)
    assert found is None or np.isfinite(found[1].reflectance.albedo).all()


DIRECTIONAL = replace(LIGHT, kind=LightKind.DIRECTIONAL, distance=float("inf"))


def _lit(light: Light) -> tuple[Objective, Candidate, ShadingEvidence]:
    scene = rendered_scene(2)
    m = len(scene.operators.model.mean_vertices)
    evidence = ShadingEvidence(
        intensity=scene.intensity,
        light=light,
        body_centre=scene.truth.translation,
        reflectance=Reflectance(
            albedo=np.full(m, 0.5),
            specularity=np.full(m, 0.08),
            ambient=0.06,
            specular_exponent=12.0,
        ),
        vertex_areas=scene.operators.shaded.areas,
        shadowed=np.zeros(m, dtype=np.bool_),
        eta=0.04,
    )
    objective = scene.objective.with_shading(evidence)
    return objective, objective.evaluate(scene.truth), evidence


@pytest.mark.parametrize("light", [LIGHT, DIRECTIONAL])
def test_slopes_are_those_of_brightness_by_finite_differences(light):
    _, candidate, evidence = _lit(light)
    rendering = candidate.rendering
    vertices = np.flatnonzero(usable_vertices(rendering, evidence))[::7]

    def brightness(step: np.ndarray) -> np.ndarray:
        moved = evidence.light
        moved = replace(moved, azimuth=moved.azimuth + step[0], elevation=moved.elevation + step[1])
        if moved.kind is LightKind.POINT:
            moved = replace(moved, distance=moved.distance * np.exp(step[2]))
        reflectance = evidence.reflectance_of(vertices)
        return shade(
            rendering.vertices[vertices],
            rendering.vertex_normals[vertices],
            light=moved,
            body_centre=evidence.body_centre,
            reflectance=replace(
                reflectance,
                ambient=reflectance.ambient + step[3],
                albedo=reflectance.albedo * np.exp(step[4]),
                specularity=reflectance.specularity * np.exp(step[5]),
            ),
        )

    small = 1e-6
    differences = [(brightness(h) - brightness(-h)) / (2 * small) for h in small * np.eye(6)]
    slopes = light_slopes(rendering, evidence, vertices)
    # Where the light grazes the surface Eq. 1 has a kink.
    smooth = shade(
        rendering.vertices[vertices],
        rendering.vertex_normals[vertices],
        light=light,
        body_centre=evidence.body_centre,
        reflectance=replace(evidence.reflectance_of(vertices), ambient=0.0),
    )
    inside = smooth > 1e-3
    assert inside.sum() > 50
    np.testing.assert_allclose(slopes[inside], np.array(differences).T[inside], atol=1e-6)


@pytest.mark.parametrize("light", [LIGHT, DIRECTIONAL])
def test_a_free_light_takes_information_and_never_more_than_there_is(light):
    objective, candidate, _ = _lit(light)
    matrix, _ = normal_equations(objective, candidate)
    rest, _ = normal_equations(objective, candidate, marginal=True)
    scale = np.sqrt(matrix.diagonal() + 1e-9)
    of_lost = np.linalg.eigvalsh((matrix - rest) / np.outer(scale, scale))
    of_rest = np.linalg.eigvalsh(rest / np.outer(scale, scale))
    assert of_lost.max() > 0.05
    assert of_lost.min() > -1e-9
    assert of_rest.min() > -1e-9


def test_a_shape_is_less_certain_under_a_light_that_is_not_known():
    objective, candidate, evidence = _lit(LIGHT)
    person = of_person(objective)
    held, _ = normal_equations(objective, candidate)
    n = len(candidate.parameters.shape)
    held[-n:, -n:] += person.shape_prior.precision
    shape = slice(len(held) - len(candidate.parameters.shape) + 1, None)
    free = np.delete(np.arange(len(held)), shape.start - 1)
    known = np.linalg.inv(held[np.ix_(free, free)])[shape.start - 1 :, shape.start - 1 :]
    (certain,) = certainty(person, person.evaluate([candidate]))
    found = shape_covariance(certain, height_variance=0.0)[1:, 1:]
    gain = np.linalg.eigvalsh(found - known)
    assert gain.min() > -1e-6
    assert gain.max() > 0.005
    assert evidence.light is LIGHT
