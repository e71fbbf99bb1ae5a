"""A motion as a BVH file on a person's own skeleton.

Centimetres, as most such files have; y up. At rest the skeleton stands in the T-pose with no joint
turned. The pelvis has its place in every frame and an offset of 0, because readers differ on
whether the one is added to the other; all other joints only turn, R = Rz Rx Ry. Names have no
colons: three.js takes what stands before one for a folder.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from fitter.applications.motion import MovingBody
from fitter.applications.skeleton import Skeleton
from fitter.arrays import Vector3
from fitter.body.model import BodyModel

_UNITS_PER_M = 100.0
_TURNS = "Zrotation Xrotation Yrotation"


def bvh_of_motion(body: MovingBody, skeleton: Skeleton, model: BodyModel) -> bytes:
    """The file; to 0.01 mm and 0.0001 degrees."""
    turns, _ = skeleton.local(skeleton.of_body(body, model))
    turns[:, 0] = body.rotations @ turns[:, 0]
    lines = ["HIERARCHY"]
    order = _hierarchy(skeleton, 0, "", lines)
    shape = (len(turns), -1)
    angles = Rotation.from_matrix(turns[:, order].reshape(-1, 3, 3)).as_euler("ZXY", degrees=True)
    numbers = np.concatenate([_UNITS_PER_M * body.roots, angles.reshape(shape)], axis=1)
    lines += [
        "MOTION",
        f"Frames: {len(numbers)}",
        f"Frame Time: {body.motion.frame_time_s:.7f}",
        *(" ".join(f"{number:.4f}" for number in row) for row in numbers),
    ]
    return ("\n".join(lines) + "\n").encode()


def _hierarchy(skeleton: Skeleton, bone: int, pad: str, lines: list[str]) -> list[int]:
    """Write a bone and what hangs on it; returns them in this order."""
    root = skeleton.parents[bone] < 0
    channels = f"6 Xposition Yposition Zposition {_TURNS}" if root else f"3 {_TURNS}"
    lines += [
        f"{pad}{'ROOT' if root else 'JOINT'} {skeleton.names[bone].replace(':', '')}",
        f"{pad}{{",
        f"{pad}\tOFFSET {_numbers(skeleton.offsets[bone])}",
        f"{pad}\tCHANNELS {channels}",
    ]
    order = [bone]
    for child in skeleton.children(bone):
        order += _hierarchy(skeleton, child, f"{pad}\t", lines)
    if bone in skeleton.ends:
        end = f"{pad}\t\tOFFSET {_numbers(skeleton.ends[bone])}"
        lines += [f"{pad}\tEnd Site", f"{pad}\t{{", end, f"{pad}\t}}"]
    lines.append(f"{pad}}}")
    return order


def _numbers(point_m: Vector3) -> str:
    return " ".join(f"{_UNITS_PER_M * number:.4f}" for number in point_m)
