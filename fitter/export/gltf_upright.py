"""The node that sets what a picture shows upright.

Body, camera and light of a posed file are in the camera's axes, where the camera is at the origin.
Where gravity is known they hang under a node that turns these axes into the upright world, so that
viewers show the body standing, and who draws it over its picture finds it as before.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from fitter.arrays import Vertices
from fitter.export.gltf_document import Frame, Node
from fitter.person.fitted_person import FittedPerson
from fitter.person.upright import upright_frame, upright_turn

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
