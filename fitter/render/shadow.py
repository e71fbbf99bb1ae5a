"""Cast shadows: what the body hides from the light. Eq. 1 does not know them."""

import numpy as np
from jaxtyping import Bool

from fitter.arrays import Triangles, Vector3, Vertices
from fitter.parameters import Light
from fitter.render.camera import Camera
from fitter.render.rasterizer import NEAR_PLANE_M, render
from fitter.render.reflectance import direction_to_light, light_position
from fitter.vocabulary.choices import LightKind

SHADOW_MAP_SIZE_PX = 768
"""Side of the shadow map: 2.5 mm a texel on a standing person."""

DISTANT_LIGHT_M = 1000.0
"""Distance of a directional light, so that one rasteriser serves both kinds: its rays diverge by
1 mm over the body, and single-precision inverse depth still resolves 0.06 mm there."""


def cast_shadow(
    vertices: Vertices, triangles: Triangles, *, light: Light, body_centre: Vector3
) -> Bool[np.ndarray, " m"]:
    """Vertices that face the light and do not see it, because the body stands between.

    A vertex that faces away from the light is in attached shadow, which Eq. 1 knows, and is not
    marked. A point light within the body's own extent casts none: the map would not hold it.
    """
    if light.kind is LightKind.DIRECTIONAL:
        source = body_centre + DISTANT_LIGHT_M * direction_to_light(light)
    else:
        source = light_position(light, body_centre)
    seen_from_light = (vertices - source) @ _look_along(body_centre - source).T
    depths = seen_from_light[:, 2]
    if depths.min() <= NEAR_PLANE_M:
        return np.zeros(len(vertices), dtype=np.bool_)
    spread = np.abs(seen_from_light[:, :2] / depths[:, None]).max()
    half_size = SHADOW_MAP_SIZE_PX / 2
    shadow_map = Camera(
        # One texel of margin keeps the outermost vertices in the map.
        focal_length_px=(half_size - 1) / spread,
        centre_x=half_size,
        centre_y=half_size,
        width=SHADOW_MAP_SIZE_PX,
        height=SHADOW_MAP_SIZE_PX,
    )
    rendering = render(seen_from_light, triangles, shadow_map)
    facing = (rendering.vertex_normals * rendering.vertices).sum(axis=1) < 0
    return facing & ~rendering.vertex_visible


def _look_along(direction: Vector3) -> np.ndarray:
    """A rotation whose third row is the given direction."""
    forward = direction / np.linalg.norm(direction)
    # The axis least parallel to the view keeps the cross product well away from zero.
    helper = np.eye(3)[np.abs(forward).argmin()]
    right = np.cross(helper, forward)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward])
