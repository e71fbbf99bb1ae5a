"""Where the vertices of a glTF mesh are while nothing is animated.

A node's place is its own in those of the nodes above it; bones move a skin. The nodes of an
animated file stand as its first frame has them, and its morph targets weigh nothing there.
"""

from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from fitter.arrays import Vertices
from fitter.export.formats.glb_file import GlbFile


def standing_vertices(file: GlbFile) -> Vertices:
    """(m, 3) vertices of the file's one mesh in the axes of its scene, metres."""
    nodes = file.document["nodes"]
    node = next(each for each in range(len(nodes)) if "mesh" in nodes[each])
    attributes = file.document["meshes"][nodes[node]["mesh"]]["primitives"][0]["attributes"]
    vertices = file.array(attributes["POSITION"]).astype(np.float64)
    if "skin" in nodes[node]:
        return _skinned(file, nodes[node]["skin"], attributes, vertices)
    place = _place(nodes, node)
    return vertices @ place[:3, :3].T + place[:3, 3]


def _skinned(file: GlbFile, skin: int, attributes: dict[str, int], vertices: Vertices) -> Vertices:
    """Vertices moved by their bones; the mesh's own node has no say."""
    bound = file.document["skins"][skin]
    # Stored column after column.
    inverse_bind = file.array(bound["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    nodes = file.document["nodes"]
    motions = np.stack([_place(nodes, joint) for joint in bound["joints"]]) @ inverse_bind
    joints = file.array(attributes["JOINTS_0"])
    weights = file.array(attributes["WEIGHTS_0"]).astype(np.float64)
    matrices = np.einsum("mb,mbij->mij", weights, motions[joints][:, :, :3])
    return np.einsum("mij,mj->mi", matrices[:, :, :3], vertices) + matrices[:, :, 3]


def _place(nodes: list[dict[str, Any]], node: int) -> Float[np.ndarray, "4 4"]:
    """From a node's axes to the scene's."""
    place = _own_place(nodes[node])
    for parent, each in enumerate(nodes):
        if node in each.get("children", ()):
            return _place(nodes, parent) @ place
    return place


def _own_place(node: dict[str, Any]) -> Float[np.ndarray, "4 4"]:
    """From a node's axes to those of the node above it."""
    place = np.eye(4)
    if "rotation" in node:
        place[:3, :3] = Rotation.from_quat(node["rotation"]).as_matrix()
    place[:3, 3] = node.get("translation", 0.0)
    return place
