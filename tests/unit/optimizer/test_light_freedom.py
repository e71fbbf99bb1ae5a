from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import ShadingEvidence, usable_vertices
from fitter.optimizer.light_solve import light_slopes
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.uncertainty import certainty, shape_covariance
from fitter.parameters import Light, Reflectance
from fitter.render.reflectance import shade
from fitter.vocabulary.choices import LightKind
from tests.unit.optimizer.rendered_scene import LIGHT, of_person, rendered_scene

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
