from dataclasses import replace

import numpy as np
import pytest

from fitter.parameters import Light, Reflectance
from fitter.render.reflectance import shade, shade_with_derivatives, shading_terms
from fitter.render.surroundings import (
    BAND_OF,
    BAND_TRANSFER,
    GLTF_SIGNS,
    harmonics,
    irradiance,
    irradiance_by_normal,
    mean_irradiance,
    uniform_surroundings,
    without_negative_light,
)
from fitter.vocabulary.choices import LightKind

CENTRE = np.array([0.1, -0.05, 3.0])
LAMP = Light(kind=LightKind.POINT, azimuth=0.6, elevation=0.4, distance=2.2)


def _directions(count: int, seed: int = 0) -> np.ndarray:
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _surroundings(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.concatenate([[1.4], 0.2 * rng.standard_normal(8)])


def test_the_harmonics_are_orthonormal():
    gauss, weights = np.polynomial.legendre.leggauss(8)
    turns = 2.0 * np.pi * np.arange(16) / 16
    z, turn = (grid.ravel() for grid in np.meshgrid(gauss, turns, indexing="ij"))
    radius = np.sqrt(1.0 - z * z)
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)
    values = harmonics(points) * np.sqrt(np.repeat(weights, 16) * 2.0 * np.pi / 16)[:, None]
    np.testing.assert_allclose(values.T @ values, np.eye(9), atol=1e-12)


def test_irradiance_is_the_clamped_cosine_integral_of_the_radiance():
    radiance = _surroundings(1)
    coefficients = np.array(BAND_TRANSFER)[BAND_OF] * radiance
    sky = _directions(400_000)
    shining = harmonics(sky) @ radiance
    for normal in _directions(5, seed=2):
        cosine = np.maximum(sky @ normal, 0.0)
        # Uniform directions have density 1 / 4π.
        integral = 4.0 * np.pi * np.mean(shining * cosine) / np.pi
        assert irradiance(coefficients, normal[None])[0] == pytest.approx(integral, abs=0.01)


def test_nine_coefficients_carry_nearly_all_of_a_lit_half_space():
    # A sky of radiance 1 over a black floor: E = (1 + cos) / 2 in closed form.
    up = np.array([0.0, -1.0, 0.0])
    sky = _directions(400_000)
    radiance = 4.0 * np.pi * (harmonics(sky) * (sky @ up > 0.0)[:, None]).mean(axis=0)
    coefficients = np.array(BAND_TRANSFER)[BAND_OF] * radiance
    normals = _directions(50, seed=3)
    exact = 0.5 * (1.0 + normals @ up)
    np.testing.assert_allclose(irradiance(coefficients, normals), exact, atol=0.01)


def test_uniform_surroundings_shine_alike_on_every_normal():
    even = uniform_surroundings(0.3)
    np.testing.assert_allclose(irradiance(even, _directions(20)), 0.3, rtol=1e-12)
    assert mean_irradiance(even) == pytest.approx(0.3)


def test_the_slope_by_the_normal_is_that_of_finite_differences():
    coefficients, normals, step = _surroundings(4), _directions(30), 1e-6
    numeric = [
        (irradiance(coefficients, normals + h) - irradiance(coefficients, normals - h)) / (2 * step)
        for h in step * np.eye(3)
    ]
    np.testing.assert_allclose(
        irradiance_by_normal(coefficients, normals), np.stack(numeric, axis=1), atol=1e-8
    )


@pytest.mark.parametrize("seed", range(6))
def test_no_direction_takes_light_away(seed):
    rng = np.random.default_rng(seed)
    wild = np.concatenate([[0.5], rng.standard_normal(8)])
    tame = without_negative_light(wild, least=0.01)
    lowest = irradiance(tame, _directions(200_000)).min()
    assert -1e-9 <= lowest < 0.01
    assert tame[0] == pytest.approx(wild[0])
    # One factor for all that differs from direction to direction.
    np.testing.assert_allclose(tame[1:] / wild[1:], tame[1] / wild[1])


@pytest.mark.parametrize("only", range(1, 9))
def test_light_along_a_single_harmonic_is_bounded_too(only):
    wild = np.zeros(9)
    wild[[0, only]] = 0.3, -2.0
    lowest = irradiance(without_negative_light(wild, least=0.01), _directions(200_000)).min()
    assert -1e-9 <= lowest < 0.01


def test_surroundings_that_take_nothing_away_are_left_alone():
    mild = np.concatenate([[1.4], np.full(8, 0.05)])
    np.testing.assert_allclose(without_negative_light(mild, least=0.01), mild)
    dark = without_negative_light(np.zeros(9), least=0.01)
    assert mean_irradiance(dark) == pytest.approx(0.01)


def test_in_gltf_axes_the_same_light_has_other_signs():
    coefficients, normals = _surroundings(5), _directions(20)
    np.testing.assert_allclose(
        irradiance(GLTF_SIGNS * coefficients, normals * [1.0, -1.0, -1.0]),
        irradiance(coefficients, normals),
        rtol=1e-12,
    )


class Lit:
    """Points on a body under a lamp, some in its shadow, and surroundings."""

    def __init__(self) -> None:
        rng = np.random.default_rng(6)
        self.normals = _directions(200, seed=7)
        self.positions = CENTRE + 0.4 * rng.normal(size=(200, 3))
        self.lit = np.where(rng.random(200) < 0.3, 0.0, 1.0)
        self.reflectance = Reflectance(
            albedo=rng.uniform(0.1, 0.8, 200),
            specularity=rng.uniform(0.0, 0.5, 200),
            ambient=0.0,
            specular_exponent=9.0,
        )
        self.light = replace(LAMP, surroundings=_surroundings(8))

    def shade(self, *, normals: np.ndarray | None = None, light: Light | None = None) -> np.ndarray:
        return shade(
            self.positions,
            self.normals if normals is None else normals,
            light=light or self.light,
            body_centre=CENTRE,
            reflectance=self.reflectance,
            lit=self.lit,
        )


def test_a_point_in_shadow_shows_its_albedo_times_the_surroundings():
    scene = Lit()
    assert scene.light.surroundings is not None
    shadow = scene.lit == 0.0
    expected = scene.reflectance.albedo * irradiance(scene.light.surroundings, scene.normals)
    np.testing.assert_allclose(scene.shade()[shadow], expected[shadow], rtol=1e-12)
    # Those that face away from the lamp show as much as in a shadow.
    assert (scene.shade()[~shadow] > expected[~shadow] - 1e-12).all()


def test_brightness_is_linear_in_albedo_and_specularity_with_surroundings():
    scene = Lit()
    terms = shading_terms(
        scene.positions,
        scene.normals,
        light=scene.light,
        body_centre=CENTRE,
        specular_exponent=9.0,
        lit=scene.lit,
    )
    reflectance = scene.reflectance
    np.testing.assert_allclose(
        reflectance.albedo * terms.diffuse + reflectance.specularity * terms.specular,
        scene.shade(),
        rtol=1e-12,
    )


def test_derivatives_with_surroundings_and_shadow_are_those_of_finite_differences():
    scene, step = Lit(), 1e-6
    found = shade_with_derivatives(
        scene.positions,
        scene.normals,
        light=scene.light,
        body_centre=CENTRE,
        reflectance=scene.reflectance,
        lit=scene.lit,
    )
    np.testing.assert_allclose(found.shading, scene.shade(), rtol=1e-12)
    # At the terminator r has a kink.
    clear = np.abs(scene.shade(light=LAMP) / scene.reflectance.albedo) > 0.02
    clear |= scene.lit == 0.0
    assert clear.sum() > 80
    numeric = np.stack(
        [
            (scene.shade(normals=scene.normals + h) - scene.shade(normals=scene.normals - h))
            / (2 * step)
            for h in step * np.eye(3)
        ],
        axis=1,
    )
    np.testing.assert_allclose(found.by_normal[clear], numeric[clear], rtol=1e-5, atol=1e-7)
    turned = [
        scene.shade(light=replace(scene.light, azimuth=scene.light.azimuth + h))
        for h in (step, -step)
    ]
    slope = (turned[0] - turned[1]) / (2 * step)
    np.testing.assert_allclose(found.by_light[clear, 0], slope[clear], rtol=1e-5, atol=1e-7)
