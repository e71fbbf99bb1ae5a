from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fitter.parameters import Light, Reflectance
from fitter.render.reflectance import (
    ShadingDerivatives,
    direction_derivatives,
    direction_to_light,
    light_position,
    shade,
    shade_with_derivatives,
)
from fitter.vocabulary.choices import LightKind
from tests.unit.render.shapes import sphere

CENTRE = np.array([0.1, -0.05, 3.0])
LIGHTS = [
    Light(kind=LightKind.POINT, azimuth=0.6, elevation=0.4, distance=2.2),
    Light(kind=LightKind.POINT, azimuth=-0.4, elevation=0.9, distance=1.2),
    Light(kind=LightKind.DIRECTIONAL, azimuth=-0.8, elevation=0.3, distance=float("inf")),
]


def equation_1(
    position: np.ndarray,
    normal: np.ndarray,
    albedo: float,
    specularity: float,
    ambient: float,
    exponent: float,
    light: Light,
    centre: np.ndarray,
) -> float:
    """The plain version, letter by letter."""
    if light.kind is LightKind.POINT:
        offset = centre + light.distance * direction_to_light(light) - position
        to_light = offset / np.linalg.norm(offset)
        intensity = light.distance**2 / (offset @ offset)
    else:
        to_light, intensity = direction_to_light(light), 1.0
    if to_light @ normal <= 0:
        return ambient
    view = -position / np.linalg.norm(position)
    halfway = (to_light + view) / np.linalg.norm(to_light + view)
    highlight = max(halfway @ normal, 0.0) ** exponent
    return ambient + intensity * (albedo * (to_light @ normal) + specularity * highlight)


class Scene:
    def __init__(self, seed: int = 0, count: int = 300) -> None:
        random = np.random.default_rng(seed)
        normals = random.normal(size=(count, 3))
        self.normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        self.positions = CENTRE + 0.4 * random.normal(size=(count, 3))
        self.reflectance = Reflectance(
            albedo=random.uniform(0.1, 0.8, count),
            specularity=random.uniform(0.0, 0.5, count),
            ambient=0.15,
            specular_exponent=9.0,
        )

    def derivatives(self, light: Light) -> ShadingDerivatives:
        return shade_with_derivatives(
            self.positions,
            self.normals,
            light=light,
            body_centre=CENTRE,
            reflectance=self.reflectance,
        )

    def well_lit(self, light: Light) -> np.ndarray:
        """Points clear of the terminator, where r has a kink."""
        offset = (
            light_position(light, CENTRE) - self.positions
            if light.kind is LightKind.POINT
            else np.broadcast_to(direction_to_light(light), self.positions.shape)
        )
        offset = offset / np.linalg.norm(offset, axis=1, keepdims=True)
        return np.abs((offset * self.normals).sum(axis=1)) > 0.01


def central_difference(function: Callable[[float], np.ndarray]) -> np.ndarray:
    step = 1e-6
    return (function(step) - function(-step)) / (2 * step)


@pytest.mark.parametrize("light", LIGHTS)
def test_shading_is_equation_1(light: Light):
    scene = Scene()
    reflectance = scene.reflectance
    result = shade(
        scene.positions, scene.normals, light=light, body_centre=CENTRE, reflectance=reflectance
    )
    expected = [
        equation_1(x, n, a, s, 0.15, 9.0, light, CENTRE)
        for x, n, a, s in zip(
            scene.positions, scene.normals, reflectance.albedo, reflectance.specularity, strict=True
        )
    ]
    np.testing.assert_allclose(result, expected, rtol=1e-12)
    np.testing.assert_allclose(scene.derivatives(light).shading, expected, rtol=1e-12)


@pytest.mark.parametrize("light", LIGHTS)
def test_surface_facing_away_from_the_light_shows_only_ambient(light: Light):
    vertices, _ = sphere(0.3, tuple(CENTRE))
    normals = (vertices - CENTRE) / 0.3
    uniform = np.full(len(vertices), 0.5)
    result = shade(
        vertices,
        normals,
        light=light,
        body_centre=CENTRE,
        reflectance=Reflectance(
            albedo=uniform, specularity=uniform, ambient=0.2, specular_exponent=2.0
        ),
    )
    # A point light at distance z lights the cap n . u > R / z, a distant one the half sphere.
    horizon = 0.3 / light.distance if light.kind is LightKind.POINT else 0.0
    lit = normals @ direction_to_light(light) > horizon
    np.testing.assert_array_equal(result[~lit], 0.2)
    assert (result[lit] > 0.2).all()


@pytest.mark.parametrize("light", LIGHTS)
def test_a_matt_surface_facing_the_light_at_the_body_centre_shows_its_albedo(light: Light):
    result = shade(
        CENTRE[None],
        direction_to_light(light)[None],
        light=light,
        body_centre=CENTRE,
        reflectance=Reflectance(
            albedo=np.array([0.7]), specularity=np.zeros(1), ambient=0.0, specular_exponent=5.0
        ),
    )
    np.testing.assert_allclose(result, 0.7, rtol=1e-12)


def test_a_mirror_direction_shows_the_whole_highlight():
    light = LIGHTS[2]
    position = np.array([[0.3, 0.2, 2.0]])
    view = -position / np.linalg.norm(position)
    halfway = view + direction_to_light(light)
    halfway /= np.linalg.norm(halfway)
    result = shade(
        position,
        halfway,
        light=light,
        body_centre=CENTRE,
        reflectance=Reflectance(
            albedo=np.zeros(1), specularity=np.array([0.4]), ambient=0.0, specular_exponent=50.0
        ),
    )
    np.testing.assert_allclose(result, 0.4, rtol=1e-12)


def test_a_far_point_light_shades_as_a_directional_one():
    scene = Scene()
    directional = LIGHTS[2]
    far = replace(directional, kind=LightKind.POINT, distance=1e7)
    shadings = [
        shade(
            scene.positions,
            scene.normals,
            light=light,
            body_centre=CENTRE,
            reflectance=scene.reflectance,
        )
        for light in (directional, far)
    ]
    np.testing.assert_allclose(shadings[0], shadings[1], atol=1e-6)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("axis", range(3))
def test_derivative_by_position_matches_finite_differences(light: Light, axis: int):
    scene = Scene()
    offset = np.eye(3)[axis]
    numeric = central_difference(
        lambda step: shade(
            scene.positions + step * offset,
            scene.normals,
            light=light,
            body_centre=CENTRE,
            reflectance=scene.reflectance,
        )
    )
    clear = scene.well_lit(light)
    analytic = scene.derivatives(light).by_position[:, axis]
    np.testing.assert_allclose(analytic[clear], numeric[clear], rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("axis", range(3))
def test_derivative_by_normal_matches_finite_differences(light: Light, axis: int):
    scene = Scene()
    offset = np.eye(3)[axis]
    numeric = central_difference(
        lambda step: shade(
            scene.positions,
            scene.normals + step * offset,
            light=light,
            body_centre=CENTRE,
            reflectance=scene.reflectance,
        )
    )
    clear = scene.well_lit(light)
    analytic = scene.derivatives(light).by_normal[:, axis]
    np.testing.assert_allclose(analytic[clear], numeric[clear], rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("parameter", ["azimuth", "elevation", "distance"])
def test_derivative_by_light_matches_finite_differences(light: Light, parameter: str):
    scene = Scene()
    column = ["azimuth", "elevation", "distance"].index(parameter)
    numeric = central_difference(
        lambda step: shade(
            scene.positions,
            scene.normals,
            body_centre=CENTRE,
            reflectance=scene.reflectance,
            light=replace(light, **{parameter: getattr(light, parameter) + step}),
        )
    )
    clear = scene.well_lit(light)
    analytic = scene.derivatives(light).by_light[:, column]
    np.testing.assert_allclose(analytic[clear], numeric[clear], rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("axis", range(3))
def test_derivative_by_body_centre_matches_finite_differences(light: Light, axis: int):
    scene = Scene()
    offset = np.eye(3)[axis]
    numeric = central_difference(
        lambda step: shade(
            scene.positions,
            scene.normals,
            light=light,
            body_centre=CENTRE + step * offset,
            reflectance=scene.reflectance,
        )
    )
    clear = scene.well_lit(light)
    analytic = scene.derivatives(light).by_body_centre[:, axis]
    np.testing.assert_allclose(analytic[clear], numeric[clear], rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize(
    ("parameter", "field"),
    [
        ("albedo", "by_albedo"),
        ("specularity", "by_specularity"),
        ("specular_exponent", "by_exponent"),
    ],
)
def test_derivative_by_reflectance_matches_finite_differences(
    light: Light, parameter: str, field: str
):
    scene = Scene()
    numeric = central_difference(
        lambda step: shade(
            scene.positions,
            scene.normals,
            light=light,
            body_centre=CENTRE,
            reflectance=replace(
                scene.reflectance, **{parameter: getattr(scene.reflectance, parameter) + step}
            ),
        )
    )
    clear = scene.well_lit(light)
    analytic = getattr(scene.derivatives(light), field)
    np.testing.assert_allclose(analytic[clear], numeric[clear], rtol=1e-5, atol=1e-8)


def test_ambient_light_adds_itself_everywhere():
    scene = Scene()
    brighter = replace(scene.reflectance, ambient=0.25)
    difference = (
        shade(
            scene.positions,
            scene.normals,
            light=LIGHTS[0],
            body_centre=CENTRE,
            reflectance=brighter,
        )
        - scene.derivatives(LIGHTS[0]).shading
    )
    np.testing.assert_allclose(difference, 0.1, rtol=1e-12)


def test_direction_derivatives_match_finite_differences():
    light = LIGHTS[0]
    for row, parameter in enumerate(("azimuth", "elevation")):
        numeric = central_difference(
            lambda step, parameter=parameter: direction_to_light(
                replace(light, **{parameter: getattr(light, parameter) + step})
            )
        )
        np.testing.assert_allclose(direction_derivatives(light)[row], numeric, atol=1e-9)


def test_azimuth_comes_from_the_right_and_elevation_from_above():
    at_camera = Light(kind=LightKind.DIRECTIONAL, azimuth=0, elevation=0, distance=float("inf"))
    np.testing.assert_allclose(direction_to_light(at_camera), [0, 0, -1], atol=1e-15)
    assert direction_to_light(replace(at_camera, azimuth=0.3))[0] > 0
    assert direction_to_light(replace(at_camera, elevation=0.3))[1] < 0
