import numpy as np
import pytest

from fitter.parameters import Light
from fitter.render.reflectance import direction_to_light, light_position
from fitter.render.shadow import cast_shadow
from fitter.vocabulary.choices import LightKind
from tests.unit.render.shapes import sphere, together

CENTRE = np.array([0.0, 0.0, 3.0])
POINT = Light(kind=LightKind.POINT, azimuth=0.5, elevation=0.3, distance=2.5)
DISTANT = Light(kind=LightKind.DIRECTIONAL, azimuth=-0.4, elevation=0.6, distance=float("inf"))


@pytest.mark.parametrize("light", [POINT, DISTANT])
def test_a_convex_body_casts_no_shadow_on_itself(light: Light):
    vertices, triangles = sphere(0.4, tuple(CENTRE))
    assert not cast_shadow(vertices, triangles, light=light, body_centre=CENTRE).any()


@pytest.mark.parametrize("light", [POINT, DISTANT])
def test_a_ball_before_the_light_shades_the_disc_behind_it(light: Light):
    to_light = direction_to_light(light)
    blocker_centre = CENTRE + 1.0 * to_light
    blocker = sphere(0.1, tuple(blocker_centre))
    body = sphere(0.4, tuple(CENTRE), subdivisions=5)
    vertices, triangles = together(blocker, body)
    shadow = cast_shadow(vertices, triangles, light=light, body_centre=CENTRE)[len(blocker[0]) :]
    normals = (body[0] - CENTRE) / 0.4
    if light.kind is LightKind.POINT:
        rays = body[0] - light_position(light, CENTRE)
        lit = (rays * normals).sum(axis=1) < 0
        cosine = -(rays @ to_light) / np.linalg.norm(rays, axis=1)
        angle = np.arccos(np.clip(cosine, -1, 1))
        shadow_angle = np.arcsin(0.1 / (light.distance - 1.0))
        margin = 0.004 / light.distance
    else:
        lit = normals @ to_light > 0
        offsets = body[0] - CENTRE
        angle = np.linalg.norm(offsets - np.outer(offsets @ to_light, to_light), axis=1)
        shadow_angle, margin = 0.1, 0.004
    assert shadow[lit & (angle < shadow_angle - margin)].all()
    assert not shadow[lit & (angle > shadow_angle + margin)].any()
    assert not shadow[~lit].any()
    assert shadow.any()


def test_a_light_within_the_body_casts_no_shadow():
    vertices, triangles = sphere(0.4, tuple(CENTRE))
    inside = Light(kind=LightKind.POINT, azimuth=0, elevation=0, distance=0.1)
    assert not cast_shadow(vertices, triangles, light=inside, body_centre=CENTRE).any()
