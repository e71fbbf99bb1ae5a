"""Where the joints of a BVH file are, frame by frame."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.applications.bvh import BvhFile
from fitter.numerics.rotations import rotation_matrices

_AXES = {"X": 0, "Y": 1, "Z": 2}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stretch:
    """Some frames of a file, in its axes and unit.

    Attributes
    ----------
    rotations
        (t, j, 3, 3) of the joints in the world, from the pose that the file calls rest.
    positions
        (t, j, 3) of the joints.
    ends
        (t, e, 3) of the chains' ends.
    """

    rotations: Float[np.ndarray, "t j 3 3"]
    positions: Float[np.ndarray, "t j 3"]
    ends: Float[np.ndarray, "t e 3"]


def stretch_of(file: BvhFile, frames: Integer[np.ndarray, " t"]) -> Stretch:
    """The joints in some frames.

    Three rotation channels are Euler angles in degrees, intrinsic in the order listed: ``Zrotation
    Xrotation Yrotation`` is R = Rz Rx Ry. A position channel stands in place of the offset, as the
    programs that write such files mean it.
    """
    numbers = np.frombuffer(file.numbers, dtype=np.float64).reshape(file.frames, -1)[frames]
    rotations = np.empty((len(numbers), len(file.names), 3, 3))
    positions = np.empty((len(numbers), len(file.names), 3))
    column = 0
    for joint, (parent, channels) in enumerate(zip(file.parents, file.channels, strict=True)):
        turn = np.broadcast_to(np.eye(3), (len(numbers), 3, 3))
        place = np.tile(np.array(file.offsets[joint]), (len(numbers), 1))
        for channel in channels:
            values = numbers[:, column]
            axis = _AXES[channel[0]]
            column += 1
            if channel.endswith("position"):
                place[:, axis] = values
            else:
                turns = np.zeros((len(values), 3))
                turns[:, axis] = np.radians(values)
                turn = turn @ rotation_matrices(turns)
        if parent < 0:
            rotations[:, joint], positions[:, joint] = turn, place
        else:
            rotations[:, joint] = rotations[:, parent] @ turn
            positions[:, joint] = positions[:, parent] + np.einsum(
                "tij,tj->ti", rotations[:, parent], place
            )
    ends = np.array(file.ends, dtype=np.float64).reshape(-1, 3)
    parents = np.array(file.end_parents, dtype=np.int64)
    return Stretch(
        rotations=rotations,
        positions=positions,
        ends=positions[:, parents] + np.einsum("teij,ej->tei", rotations[:, parents], ends),
    )
