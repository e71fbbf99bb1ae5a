"""BVH files of a person's own skeleton, under any program's names and in any axes."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from fitter.applications.poses import Rig

CHILDREN_FIRST = "ZXY"

CMU = {
    "pelvis": "Hips",
    "spine": "lowerback",
    "chest": "Chest",
    "neck": "Neck",
    "head": "Head",
}
MIXAMO = {
    "pelvis": "mixamorig:Hips",
    "spine": "mixamorig:Spine",
    "chest": "mixamorig:Spine1",
    "neck": "mixamorig:Neck",
    "head": "mixamorig:Head",
}
ROKOKO = {"pelvis": "Hips", "spine": "Spine", "chest": "Spine2", "neck": "Neck", "head": "Head"}
RIGIFY = {
    "pelvis": "DEF-spine",
    "spine": "DEF-spine.001",
    "chest": "DEF-spine.003",
    "neck": "DEF-spine.004",
    "head": "DEF-spine.006",
}
for _side in ("left", "right"):
    _big = _side.capitalize()
    for _limb, _cmu, _mixamo, _rokoko, _rigify in (
        ("upper_arm", "Shoulder", "Arm", "Arm", "upper_arm"),
        ("forearm", "Elbow", "ForeArm", "ForeArm", "forearm"),
        ("hand", "Wrist", "Hand", "Hand", "hand"),
        ("thigh", "Hip", "UpLeg", "Thigh", "thigh"),
        ("shin", "Knee", "Leg", "Shin", "shin"),
        ("foot", "Ankle", "Foot", "Foot", "foot"),
    ):
        _part = f"{_side}_{_limb}"
        CMU[_part] = f"{_big}{_cmu}"
        MIXAMO[_part] = f"mixamorig:{_big}{_mixamo}"
        ROKOKO[_part] = f"{_big}{_rokoko}"
        RIGIFY[_part] = f"DEF-{_rigify}.{_big[0]}"

NAMES = {"CMU": CMU, "Mixamo": MIXAMO, "Rokoko": ROKOKO, "Blender Rigify": RIGIFY}


def bvh_of(
    rig: Rig,
    *,
    names: Mapping[str, str],
    poses: np.ndarray,
    roots: np.ndarray,
    order: str = CHILDREN_FIRST,
    axes: np.ndarray | None = None,
    unit_m: float = 1.0,
    rest_turns: Mapping[str, np.ndarray] | None = None,
    frame_time_s: float = 1 / 30,
    without: Sequence[str] = (),
) -> bytes:
    """The file of a motion of ``rig``'s own skeleton.

    Parameters
    ----------
    names
        By part.
    poses, roots
        (t, p, 3), (t, 3) body frame.
    order
        Of the rotation channels.
    axes
        (3, 3) from the body frame to the file's axes; as they are if None.
    unit_m
        Metres of the file's unit.
    rest_turns
        By part: global rotations that turn the rest skeleton into the file's rest, whose bones
        they turn.
    without
        Parts of trunk or head the file lacks.
    """
    axes = np.eye(3) if axes is None else axes
    count = len(rig.part_names)
    parents = [int(parent) for parent in rig.part_parent]
    for part, name in enumerate(rig.part_names):
        if name in without:
            parents = [parents[part] if parent == part else parent for parent in parents]
    rest_turn = np.tile(np.eye(3), (count, 1, 1))
    for name, turn in (rest_turns or {}).items():
        rest_turn[rig.index(name)] = turn
    turned = np.empty((len(poses), count, 3, 3))
    for part, parent in enumerate(rig.part_parent):
        local = Rotation.from_rotvec(poses[:, part]).as_matrix()
        turned[:, part] = local if parent < 0 else turned[:, parent] @ local
    # The file's joints turn from its own rest: R_source = R_target A^-1 with A the rest turn.
    source = turned @ rest_turn.transpose(0, 2, 1)
    lines = ["HIERARCHY"]
    order_of_parts: list[int] = []

    def write(part: int, depth: int) -> None:
        order_of_parts.append(part)
        pad = "  " * depth
        parent = parents[part]
        bone = rig.rest_joints[part] - (rig.rest_joints[parent] if parent >= 0 else 0.0)
        offset = axes @ (rest_turn[parent] @ bone if parent >= 0 else bone) / unit_m
        channels = [f"{axis}rotation" for axis in order]
        if parent < 0:
            channels = ["Xposition", "Yposition", "Zposition", *channels]
        lines.append(f"{pad}{'ROOT' if parent < 0 else 'JOINT'} {names[rig.part_names[part]]}")
        lines.append(pad + "{")
        lines.append(f"{pad}  OFFSET " + " ".join(f"{x:.9f}" for x in offset))
        lines.append(f"{pad}  CHANNELS {len(channels)} {' '.join(channels)}")
        children = [child for child in range(count) if parents[child] == part]
        children = [child for child in children if rig.part_names[child] not in without]
        for child in children:
            write(child, depth + 1)
        if not children:
            end = axes @ rest_turn[part] @ np.array([0.0, -0.05, 0.1]) / unit_m
            lines.extend(
                [f"{pad}  End Site", pad + "  {", f"{pad}    OFFSET {end[0]} {end[1]} {end[2]}"]
            )
            lines.append(pad + "  }")
        lines.append(pad + "}")

    write(0, 0)
    lines += ["MOTION", f"Frames: {len(poses)}", f"Frame Time: {frame_time_s:.9f}"]
    for frame in range(len(poses)):
        numbers = list(axes @ roots[frame] / unit_m)
        for part in order_of_parts:
            parent = parents[part]
            local = source[frame, part]
            if parent >= 0:
                local = source[frame, parent].T @ local
            local = axes @ local @ axes.T
            numbers += list(Rotation.from_matrix(local).as_euler(order, degrees=True))
        lines.append(" ".join(f"{number:.10f}" for number in numbers))
    return "\n".join(lines).encode()
