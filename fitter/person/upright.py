"""The upright world of a picture: y against gravity, the person on the floor y = 0."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.numerics.rotations import rotation_matrices
from fitter.parameters import CameraTilt


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class UprightFrame:
    """From the camera frame (OpenCV axes) to a world with y up, both in metres.

    x is horizontal and to the camera's right, and a level camera looks along -z.

    Attributes
    ----------
    rotation
        (3, 3); world = rotation @ camera + translation.
    translation
        (3,) where the camera is in the world.
    """

    rotation: Float[np.ndarray, "3 3"]
    translation: Vector3

    def points(self, points: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 3"]:
        """Points of the camera frame in the world."""
        return points @ self.rotation.T + self.translation


def upright_rotation(tilt: CameraTilt) -> Float[np.ndarray, "3 3"]:
    """From the camera frame to the world: R_x(pitch) R_z(-roll) diag(1, -1, -1)."""
    about_x, about_z = rotation_matrices(np.array([[tilt.pitch, 0.0, 0.0], [0.0, 0.0, -tilt.roll]]))
    return about_x @ about_z * CAMERA_AXES


def upright_turn(tilt: CameraTilt | None) -> Float[np.ndarray, "3 3"]:
    """From the camera's axes turned to y up, as those of the body frame, to the world's.

    The same axes where the tilt is not known.
    """
    return np.eye(3) if tilt is None else upright_rotation(tilt) * CAMERA_AXES


def upright_frame(tilt: CameraTilt, *, vertices: Vertices, root: Vector3) -> UprightFrame:
    """The world in which the root joint is above the origin and the lowest vertex on the floor.

    That is the sole of whoever stands; a picture does not tell how high somebody jumps.

    Parameters
    ----------
    vertices, root
        (m, 3) and (3,) camera frame, metres.
    """
    rotation = upright_rotation(tilt)
    x, _, z = rotation @ root
    return UprightFrame(
        rotation=rotation,
        translation=np.array([-x, -float((vertices @ tilt.up).min()), -z]),
    )
