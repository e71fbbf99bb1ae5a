"""The fitted body as glTF 2.0 binary files.

``body_posed.glb`` lies in the camera frame with glTF's axes (OpenCV x diag(1, -1, -1): x right,
y up, looking along -z), metres, so that its camera node is the identity, under a node that sets all
of it upright (:mod:`fitter.export.gltf`); it carries camera, light, and reflectance per
vertex. ``body_canonical.glb`` lies in the body frame (y up, facing +z) in the canonical pose with
its feet on y = 0. Vertex order is the body model's, in both.

Metres, y up, the lowest vertex at y = 0; vertex order is the body model's.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from fitter.arrays import Vector3, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.export.glb import BinaryChunk, Frame, Node, gltf_document, pack_glb
from fitter.export.gltf_mesh import BODY_NODE, BodyTexture, add_body_mesh, colour_scale_of
from fitter.parameters import Light, Reflectance
from fitter.person.fitted_person import FittedPerson
from fitter.person.upright import upright_frame, upright_turn
from fitter.render.camera import Camera
from fitter.render.reflectance import direction_to_light, light_position
from fitter.result import FitResult, PictureFit
from fitter.vocabulary.choices import LightKind


def plain_glb(
    vertices: Vertices,
    model: BodyModel,
    *,
    name: str,
    frame: Frame,
    extras: Mapping[str, object],
    reflectance: Reflectance | None = None,
    albedo_rgb: Vertices | None = None,
    texture: BodyTexture | None = None,
) -> bytes:
    """The mesh with its texture or in the colours of its skin, else in a neutral one.

    Parameters
    ----------
    vertices
        (m, 3) y up, metres.
    model
        Whose triangles and provenance.
    name
        Of the scene.
    frame
        What the axes are.
    extras
        What else is said of the body, beside its provenance; JSON values.
    reflectance, albedo_rgb
        Per vertex.
    texture
        Shown in their place.
    """
    standing = vertices - np.array([0.0, vertices[:, 1].min(), 0.0])
    return _with_mesh(
        gltf_document([BODY_NODE], model, name=name, frame=frame, extras=extras),
        standing,
        model,
        reflectance=reflectance,
        albedo_rgb=albedo_rgb,
        texture=texture,
    )


def _with_mesh(
    document: dict[str, Any],
    vertices: Vertices,
    model: BodyModel,
    *,
    reflectance: Reflectance | None = None,
    albedo_rgb: Vertices | None = None,
    texture: BodyTexture | None = None,
) -> bytes:
    """The file of a document and its one mesh; vertices in the file's axes."""
    binary = BinaryChunk()
    add_body_mesh(
        document,
        binary,
        vertices=vertices,
        triangles=model.triangles,
        reflectance=reflectance,
        albedo_rgb=albedo_rgb,
        texture=texture,
    )
    return pack_glb(document, binary)


def body_posed_glb(found: PictureFit, model: BodyModel) -> bytes:
    """The posed body with its camera, light and reflectance."""
    person = found.person
    document = pictured_document(
        person,
        model,
        found.posed_vertices,
        name="body_posed",
        colour_scale=colour_scale_of(person.reflectance, person.albedo_rgb),
        extras=_provenance(found),
    )
    return _with_mesh(
        document,
        found.posed_vertices * CAMERA_AXES,
        model,
        reflectance=person.reflectance,
        albedo_rgb=person.albedo_rgb,
    )


def textured_glb(
    posed_vertices: Vertices,
    model: BodyModel,
    texture: BodyTexture,
    *,
    person: FittedPerson,
    colour_scale: float = 1.0,
    extras: Mapping[str, object],
) -> bytes:
    """The posed body with a picture on its skin, before the camera of its fit.

    Parameters
    ----------
    posed_vertices
        (m, 3) camera frame, metres.
    model
        Whose triangles and atlas.
    person
        Whose camera the file gets and, for a texture without light, whose light.
    colour_scale
        Linear values are the texture's times this.
    extras
        What else is said of it; JSON values.
    """
    document = pictured_document(
        person,
        model,
        posed_vertices,
        name="body_textured",
        colour_scale=None if texture.is_lit else colour_scale,
        extras=extras,
    )
    return _with_mesh(document, posed_vertices * CAMERA_AXES, model, texture=texture)


def body_canonical_glb(result: FitResult, model: BodyModel) -> bytes:
    """The body in the canonical pose, standing on y = 0."""
    return plain_glb(
        result.canonical_vertices,
        model,
        name="body_canonical",
        frame=Frame.STANDING,
        extras=_provenance(result.found),
        reflectance=result.person.reflectance,
        albedo_rgb=result.person.albedo_rgb,
    )


def _provenance(found: PictureFit) -> dict[str, object]:
    """The fit that a file comes from."""
    return {
        "method": "Guan, Weiss, Balan, Black: Estimating Human Shape and Pose from a Single "
        "Image, ICCV 2009",
        "height_m": found.height_m,
        "cues": found.cues.value,
        "outcome": found.outcome.value,
    }


def pictured_document(
    person: FittedPerson,
    model: BodyModel,
    posed_vertices: Vertices,
    *,
    name: str,
    colour_scale: float | None,
    extras: Mapping[str, object],
) -> dict[str, Any]:
    """A document of body, camera and light, set upright if it is known how; still without mesh.

    Parameters
    ----------
    posed_vertices
        (m, 3) camera frame, metres.
    name
        Of the scene.
    colour_scale
        What the light is multiplied by; None for colours that have their light in them.
    extras
        What else is said of the body; JSON values.
    """
    nodes: list[Node] = [BODY_NODE, CAMERA_NODE]
    shining: dict[str, Any] = {}
    if colour_scale is not None and person.light is not None and person.reflectance is not None:
        light, placement = light_and_node(
            person.light,
            body_centre=person.body.translation,
            colour_scale=colour_scale,
            reflectance=person.reflectance,
        )
        nodes.append(placement)
        shining = {"extensions": {PUNCTUAL: {"lights": [light]}}}
    nodes, frame = set_upright(nodes, person, posed_vertices)
    document = gltf_document(nodes, model, name=name, frame=frame, extras=extras)
    return document | {"cameras": [camera_description(person.camera)]} | shining


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


UPRIGHT_NODE = "upright"


def set_upright(
    nodes: list[Node], person: FittedPerson, posed_vertices: Vertices
) -> tuple[list[Node], Frame]:
    """The nodes of a file in the camera's axes, set upright if it is known how; and the frame.

    Parameters
    ----------
    posed_vertices
        (m, 3) camera frame, metres.
    """
    if person.tilt is None:
        return nodes, Frame.CAMERA
    world = upright_frame(person.tilt, vertices=posed_vertices, root=person.body.translation)
    upright: Node = {
        "name": UPRIGHT_NODE,
        "children": list(range(len(nodes))),
        "rotation": Rotation.from_matrix(upright_turn(person.tilt)).as_quat().tolist(),
        "translation": np.asarray(world.translation).tolist(),
    }
    return [*nodes, upright], Frame.UPRIGHT
