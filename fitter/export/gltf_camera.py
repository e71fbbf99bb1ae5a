"""A pinhole camera as glTF has it, and what glTF cannot say of it."""

import math

from fitter.export.gltf_document import Node
from fitter.render.camera import Camera

NEAR_PLANE_M = 0.01

CAMERA_NODE: Node = {"camera": 0, "name": "camera"}
"""At the origin, looking along -z: a file in the camera's axes has its camera there."""


def camera_description(camera: Camera) -> dict[str, object]:
    """The camera of a picture of w x h pixels: yfov = 2 atan(h / 2 f), and its extras.

    glTF has no principal point; with it off the middle, the extras say what yfov cannot, in pixels
    of the upright original.
    """
    return {
        "type": "perspective",
        "name": "camera",
        "perspective": {
            "yfov": 2.0 * math.atan(camera.height / (2.0 * camera.focal_length_px)),
            "aspectRatio": camera.width / camera.height,
            "znear": NEAR_PLANE_M,
        },
        "extras": {
            "fx_px": camera.focal_length_px,
            "fy_px": camera.focal_length_px,
            "cx_px": camera.centre_x,
            "cy_px": camera.centre_y,
            "width_px": camera.width,
            "height_px": camera.height,
        },
    }
