"""The glTF document of a body before the camera of its fit, in the light that was found."""

from collections.abc import Mapping
from typing import Any

from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.export.gltf_camera import CAMERA_NODE, camera_description
from fitter.export.gltf_document import Node, gltf_document
from fitter.export.gltf_light import PUNCTUAL, light_and_node
from fitter.export.gltf_mesh import BODY_NODE
from fitter.export.gltf_upright import set_upright
from fitter.person.fitted_person import FittedPerson


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
