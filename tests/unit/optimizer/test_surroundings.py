"""Light from all round is found beside the lamp, and neither passes for the other."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body, Candidate
from fitter.energies.shading import explained_vertices, seen_vertices, usable_vertices
from fitter.evidence.intensity import IntensityMap
from fitter.optimizer.alternation import ShadedFit
from fitter.optimizer.gauss_newton import Minimum, minimize_gauss_newton
from fitter.optimizer.light_solve import (
    estimate_light,
    guessed_lights,
    surroundings_prior,
)
from fitter.optimizer.light_step import first_state, with_explained_shadows, with_new_shadows
from fitter.optimizer.lit_surface import LightEstimate, LitSurface
from fitter.parameters import Light, Reflectance
from fitter.render.light import direction_to_light
from fitter.render.reflectance import shade
from fitter.render.shadow import cast_shadow, lamp_seen
from fitter.render.surroundings import irradiance, mean_irradiance, uniform_surroundings
from fitter.request import LightGuess
from fitter.vocabulary.choices import LightKind, SurroundingsKind
from tests.unit.optimizer.rendered_scene import LIGHT, RenderedScene, lit_fit, rendered_scene
from tests.unit.render.shapes import sphere

# Brighter from above and from the left, in a room.
AROUND = np.array([1.1, -0.15, 0.02, -0.12, 0.02, 0.01, -0.01, 0.0, 0.02])
# From high up, the head and the arms cast shadows.
SURROUNDED = replace(LIGHT, elevation=1.0, surroundings=AROUND)
CENTRE = np.array([0.0, 0.0, 3.0])


def degrees_between(first: Light, second: Light) -> float:
    cosine = direction_to_light(first) @ direction_to_light(second)
    return float(np.degrees(np.arccos(min(cosine, 1.0))))


def test_the_priors_slopes_are_those_of_finite_differences():
    step = 1e-6
    numeric = [
        (surroundings_prior(AROUND + h)[0] - surroundings_prior(AROUND - h)[0]) / (2 * step)
        for h in step * np.eye(9)
    ]
    np.testing.assert_allclose(surroundings_prior(AROUND)[1], np.array(numeric).T, atol=1e-6)
    # Brighter surroundings are as uneven as before.
    np.testing.assert_allclose(surroundings_prior(3.0 * AROUND)[0], surroundings_prior(AROUND)[0])


@pytest.mark.parametrize("kind", list(LightKind))
def test_lamp_and_surroundings_of_a_sphere_are_found(kind):
    lamp = replace(LIGHT, kind=kind, distance=2.5 if kind is LightKind.POINT else np.inf)
    true = replace(lamp, surroundings=AROUND)
    points, _ = sphere(0.5, tuple(CENTRE))
    normals = (points - CENTRE) / 0.5
    seen = normals[:, 2] < -0.2
    points, normals = points[seen], normals[seen]
    count = len(points)
    observed = shade(
        points,
        normals,
        light=true,
        body_centre=CENTRE,
        reflectance=Reflectance(
            albedo=np.full(count, 0.4),
            specularity=np.full(count, 0.1),
            ambient=0.0,
            specular_exponent=12.0,
        ),
    )
    surface = LitSurface(
        positions=points,
        normals=normals,
        observed=observed,
        weights=np.full(count, 1.0 / count),
        albedo=np.ones(count),
        specularity=np.ones(count),
        ambient_limit=0.0,
        body_centre=CENTRE,
        specular_exponent=12.0,
        eta=0.05,
    )
    start = LightEstimate(
        light=replace(
            lamp,
            azimuth=lamp.azimuth - 0.3,
            elevation=lamp.elevation + 0.2,
            surroundings=uniform_surroundings(0.2),
        ),
        ambient=0.0,
        albedo_scale=0.3,
        specularity_scale=0.05,
        energy=1.0,
    )
    found = estimate_light(surface, start, iterations=60)
    assert found.light.surroundings is not None
    assert degrees_between(found.light, true) < 3.0
    assert found.albedo_scale == pytest.approx(0.4, rel=0.1)
    assert found.ambient == 0.0
    np.testing.assert_allclose(
        irradiance(found.light.surroundings, normals), irradiance(AROUND, normals), atol=0.06
    )


@pytest.fixture(scope="module")
def scene() -> RenderedScene:
    return rendered_scene(0, SURROUNDED)


@pytest.fixture(scope="module")
def lit(scene) -> tuple[Candidate, ShadedFit]:
    found = lit_fit(
        scene,
        scene.objective.evaluate(scene.truth),
        partial(minimize_gauss_newton, max_evaluations=20, on_energies=lambda _: None),
        guessed_lights(LightGuess()),
        SurroundingsKind.SPHERICAL_HARMONICS,
    )
    assert found is not None
    return found


@pytest.fixture(scope="module")
def shaded(lit) -> ShadedFit:
    return lit[1]


def known_and_shadow(
    scene: RenderedScene, lit: tuple[Candidate, ShadedFit]
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices whose reflectance was seen, and those of them that lie in a shadow."""
    final, shaded = lit
    shown = with_explained_shadows(scene.objective, final, shaded.evidence)
    known = explained_vertices(final.rendering, shown)
    return known, known & ~usable_vertices(final.rendering, shown)


def test_shadows_tell_nothing_of_the_body(shaded):
    assert shaded.evidence.lit is None
    assert shaded.evidence.shadowed.any()


def test_lamp_and_surroundings_of_a_body_are_found(shaded):
    assert degrees_between(shaded.light, SURROUNDED) < 6.0
    found = mean_irradiance(shaded.light.surroundings)
    assert found == pytest.approx(mean_irradiance(AROUND), rel=0.35)
    assert shaded.reflectance.ambient == 0.0
    # More light from above than from below, and from the left than from the right.
    toward = np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    above, below = irradiance(shaded.light.surroundings, toward)
    assert above > below


def test_what_is_found_explains_the_picture_in_shadows_too(scene, lit):
    final, shaded = lit
    seen = lamp_seen(
        final.vertices,
        scene.operators.model.triangles,
        light=shaded.light,
        body_centre=final.parameters.translation,
    )
    assert seen is not None
    predicted = shade(
        final.vertices,
        final.rendering.vertex_normals,
        light=shaded.light,
        body_centre=final.parameters.translation,
        reflectance=shaded.reflectance,
        lit=seen,
    )
    known, shadow = known_and_shadow(scene, lit)
    assert shadow.sum() > 30, "this lamp casts a shadow that is seen"
    for chosen in (known & ~shadow, shadow & (seen == 0.0)):
        observed = scene.intensity.at(final.rendering.projected[chosen])
        missed = np.median(np.abs(predicted[chosen] - observed))
        assert missed < 0.05 * np.median(observed)


def test_albedo_in_a_shadow_is_that_of_the_light(scene, lit, shaded):
    """The whole body has one albedo: the shadow must not look like another skin."""
    known, shadow = known_and_shadow(scene, lit)
    albedo = shaded.reflectance.albedo
    assert np.median(albedo[shadow]) == pytest.approx(np.median(albedo[known]), rel=0.15)


def test_surroundings_leave_equation_1_as_it_was():
    """What no caller asked for must not be felt: no field of the evidence is set."""
    plain = rendered_scene(0)
    lit = lit_fit(
        plain,
        plain.objective.evaluate(plain.truth),
        partial(minimize_gauss_newton, max_evaluations=2, on_energies=lambda _: None),
        guessed_lights(LightGuess()),
    )
    assert lit is not None
    final, found = lit
    assert found.light.surroundings is None
    assert found.evidence.lit is None
    np.testing.assert_array_equal(
        explained_vertices(final.rendering, found.evidence),
        usable_vertices(final.rendering, found.evidence),
    )


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
    assert explained_vertices(candidate.rendering, kept).any()
    for kind in SurroundingsKind:
        found = lit_fit(dark, candidate, as_it_is, (high,), kind, intensity)
        assert found is None or np.isfinite(found[1].reflectance.albedo).all()


def test_half_a_face_does_not_tell_surroundings_from_the_lamp():
    plain = rendered_scene(1)
    model, candidate = plain.operators.model, plain.objective.evaluate(plain.truth)
    head = np.zeros(len(candidate.vertices), dtype=np.bool_)
    triangles = model.triangles[model.part_of_triangle == model.part_names.index("head")]
    head[np.unique(triangles)] = True
    columns = candidate.rendering.projected[:, 0]
    intensity = seeing_only(plain, head & (columns < np.median(columns[head])))
    lit = lit_fit(
        plain,
        candidate,
        as_it_is,
        guessed_lights(LightGuess()),
        SurroundingsKind.SPHERICAL_HARMONICS,
        intensity,
    )
    assert lit is not None
    _, found = lit
    assert found.light.surroundings is None
    assert degrees_between(found.light, LIGHT) < 10.0
