"""What every glTF file of ours begins with: its nodes, the scene that shows them, its origin."""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from fitter.body.model import BodyModel

Node = dict[str, Any]
"""A node as glTF has it; the ids in it are places in the list of nodes."""


class Frame(StrEnum):
    """The axes of a file, as its extras say them. All are right-handed, in metres."""

    STANDING = "metres; +y is up, the body faces +z and stands on y = 0"
    ON_THE_GROUND = "metres; +y is up, the ground is y = 0"
    UPRIGHT = (
        "metres; +y points against gravity as it was estimated, and the lowest point is at y = 0. "
        "The node 'upright' turns the camera's axes into these: in it the camera stands at the "
        "origin and looks along -z, +x is right and +y up in its picture"
    )
    CAMERA = (
        "metres; the camera's axes: it stands at the origin and looks along -z, +x is right and +y "
        "up in its picture. Which way gravity points is not known"
    )
    CAMERA_TURNED = (
        "metres; +y is up in the picture and +z leads to the camera; the lowest point is at y = 0. "
        "Which way gravity points is not known"
    )


def gltf_document(
    nodes: Sequence[Node],
    model: BodyModel,
    *,
    name: str,
    frame: Frame,
    extras: Mapping[str, object],
) -> dict[str, Any]:
    """A glTF document of one scene that shows all nodes; still without meshes.

    The scene lists the nodes that are no other node's children: what a scene does not reach, no
    viewer shows.

    Parameters
    ----------
    nodes
        All there are.
    model
        Whose provenance.
    name
        Of the scene.
    frame
        The axes the nodes are in.
    extras
        What else is said of the body; JSON values.
    """
    children = {child for node in nodes for child in node.get("children", ())}
    said = {
        "generator": generator_name(),
        "gender": model.gender,
        "frame": frame.value,
        "body_model": {
            "checksum": str(model.header.get("checksum", "")),
            "sources": model.header.get("sources", ""),
            "licences": model.header.get("licences", ""),
        },
        **extras,
    }
    shown = [index for index in range(len(nodes)) if index not in children]
    return {
        # Blender keeps the scene's extras but drops the asset's, so both carry them.
        "asset": {"version": "2.0", "generator": generator_name(), "extras": said},
        "scene": 0,
        "scenes": [{"name": name, "nodes": shown, "extras": said}],
        "nodes": list(nodes),
    }


@cache
def generator_name() -> str:
    """The program and its version as glTF's ``asset.generator`` wants them.

    Once a process: finding the version reads and parses the package's metadata.
    """
    try:
        return f"Maquette {version('maquette')}"
    except PackageNotFoundError:
        return "Maquette (not installed)"
