"""The light of Eq. 1 as glTF's KHR_lights_punctual has it."""

import math

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.body.scape import CAMERA_AXES
from fitter.export.gltf_document import Node
from fitter.parameters import Light, Reflectance
from fitter.render.light import direction_to_light, light_position
from fitter.vocabulary.choices import LightKind

PUNCTUAL = "KHR_lights_punctual"


def light_and_node(
    light: Light, *, body_centre: Vector3, colour_scale: float, reflectance: Reflectance
) -> tuple[dict[str, object], Node]:
    """The light of Eq. 1 as KHR_lights_punctual describes it, and the node that places it.

    The node does not switch it on: viewers bring light of their own, and one more burns the body
    out. Whoever wants the picture's light gives the node the extension ``{"light": 0}``, or makes
    a light of the description where the node "light" stands.

    Eq. 1 leaves out the 1/π of a Lambertian surface, glTF does not: a surface of albedo a facing
    a light of l = 1 shines a l = (a/π)(π l), so illuminance is π l. A point light attenuated from
    l = 1 at the body's centre, at distance d, is π l d² candela; a directional one π l lux.
    glTF's lights shine along their node's -z.
    """
    extras: dict[str, object] = {
        "azimuth_rad": light.azimuth,
        "elevation_rad": light.elevation,
        "intensity_at_body_centre": 1.0,
        "ambient": reflectance.ambient,
        "specular_exponent": reflectance.specular_exponent,
        "colour_scale": colour_scale,
    }
    to_light = direction_to_light(light) * CAMERA_AXES
    illuminance = math.pi * colour_scale
    node: Node = {"name": "light", "extras": {"light": 0}}
    if light.kind is LightKind.POINT:
        node["translation"] = (light_position(light, body_centre) * CAMERA_AXES).tolist()
        intensity = illuminance * light.distance**2
        extras["distance_m"] = light.distance
    else:
        node["rotation"] = quaternion_from_z_to(to_light).tolist()
        intensity = illuminance
    return (
        {
            "type": light.kind.value,
            "name": "light",
            "color": [1.0, 1.0, 1.0],
            "intensity": intensity,
            "extras": extras,
        },
        node,
    )


def quaternion_from_z_to(direction: Vector3) -> Float[np.ndarray, "4"]:
    """The shortest rotation that takes +z to a unit direction, as glTF's (x, y, z, w)."""
    x, y, z = direction
    if z < -1.0 + 1e-12:
        return np.array([1.0, 0.0, 0.0, 0.0])
    quaternion = np.array([-y, x, 0.0, 1.0 + z])
    return quaternion / np.linalg.norm(quaternion)
