"""Motion of another skeleton on a person's own.

In axes that both share, a part turns from rest as the source's joint does: R_target = R_source A,
where A takes the person's bone at rest to where the source's bone is at rest, the short way. Trunk
and head are upright in both, so their A is the identity; a hand goes along with its forearm. So are
feet, unless the source's rest foot is tilted with a splayed leg, as CMU's are: then A tilts ours.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.applications.bvh import BvhClip
from fitter.applications.motion import Motion
from fitter.applications.poses import shortest_rotation
from fitter.applications.rig import Rig
from fitter.applications.skeletons import joints_of_parts
from fitter.arrays import Vector3
from fitter.errors import InvalidInputError
from fitter.numerics.rotations import rotation_matrices, rotation_vectors

LIFT_DEAD_ZONE_M = 0.05
"""The source's lowest joint rises and falls by so much in walking, as heel and toe take turns: only
what goes beyond is taken for leaving the ground."""

GROUND_PERCENTILE = 10.0
"""Of the lowest joint's height over the clip: the source's ground."""

FARTHEST_M = 1000.0
"""From where a clip begins; farther goes only a file whose positions are in another unit."""

_TILTED_FOOT_DEG = 3.0
"""So near to the shin's lean, seen from the front, the bone to the toes leans with it. Those of
CMU's skeletons agree to 0.1 degrees, with shins that lean by 20."""

_DOWN = np.array([0.0, -1.0, 0.0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Retargeted:
    """A source's motion on a person's skeleton.

    ``naming`` is the program whose names the source has, ``scale`` metres of the person by unit
    of the source's length.
    """

    motion: Motion
    naming: str
    scale: float


def retarget(clip: BvhClip, rig: Rig, frames: slice, *, field: str = "bvh") -> Retargeted:
    """Some frames of a clip as poses of a person.

    The person faces forward in the first frame and begins above the origin.

    Parameters
    ----------
    clip
        The source.
    rig
        The person's skeleton.
    frames
        Which frames, with a step of at least one.
    field
        The request field errors name.

    Raises
    ------
    InvalidInputError
        If the skeleton's joints cannot be told, or it has no up, no left or no legs at rest.
    """
    naming, joints = joints_of_parts(clip.names, field=field)
    rest = clip.rest_positions()
    axes = _body_axes(rest, joints, field)
    rest = rest @ axes.T
    rotations, positions = clip.motion(frames)
    rotations = axes @ rotations @ axes.T
    positions = positions @ axes.T
    scale = _leg_length(rig) / _source_leg_length(rest, joints, field)
    poses = _poses(rig, clip, rest, joints, rotations, axes)
    roots = scale * positions[:, joints["pelvis"]]
    ends = positions[:, clip.end_parent] + np.einsum(
        "teij,ej->tei", rotations[:, clip.end_parent], clip.ends @ axes.T
    )
    lowest = scale * np.concatenate([positions, ends], axis=1)[:, :, 1].min(axis=1)
    ground = float(np.percentile(lowest, GROUND_PERCENTILE))
    lifts = np.maximum(lowest - ground - LIFT_DEAD_ZONE_M, 0.0)
    farthest = max(float(np.linalg.norm(roots - roots[0], axis=1).max()), float(lifts.max()))
    if not farthest <= FARTHEST_M:
        raise InvalidInputError(
            code="bvh-too-far",
            field=field,
            reason=(
                f"The body moves {farthest:.3g} m away, by the length of the legs; more than "
                f"{FARTHEST_M:g}."
            ),
            remedy="Export hips and offsets in the same unit.",
        )
    facing = _facing_forward(rotations[0, joints["pelvis"]])
    poses[:, 0] = rotation_vectors(facing @ rotation_matrices(poses[:, 0]))
    step = frames.step or 1
    return Retargeted(
        motion=Motion(
            frame_time_s=clip.frame_time_s * step,
            poses=poses,
            roots=(roots - [roots[0, 0], ground, roots[0, 2]]) @ facing.T,
            lifts_m=lifts,
        ),
        naming=naming,
        scale=scale,
    )


def _body_axes(
    rest: Float[np.ndarray, "j 3"], joints: dict[str, int], field: str
) -> Float[np.ndarray, "3 3"]:
    """Rows: left, up and forward of the source in its own axes, whichever these are."""
    shoulders = rest[joints["left_upper_arm"]] + rest[joints["right_upper_arm"]]
    hips = rest[joints["left_thigh"]] + rest[joints["right_thigh"]]
    left = sum(
        rest[joints[f"left_{limb}"]] - rest[joints[f"right_{limb}"]]
        for limb in ("upper_arm", "thigh", "shin")
    )
    up = _nearest_axis(shoulders - hips)
    sideways = _nearest_axis(np.where(up != 0.0, 0.0, left))
    if not up.any() or not sideways.any():
        raise _no_rest(field, "its shoulders are not above its hips, or left is where right is")
    return np.stack([sideways, up, np.cross(sideways, up)])


def _nearest_axis(direction: Vector3) -> Vector3:
    axis = np.zeros(3)
    largest = int(np.argmax(np.abs(direction)))
    axis[largest] = np.sign(direction[largest])
    return axis


def _leg_length(rig: Rig) -> float:
    return float(
        sum(
            np.linalg.norm(rig.bone(f"{side}_{upper}", f"{side}_{lower}"))
            for side in ("left", "right")
            for upper, lower in (("thigh", "shin"), ("shin", "foot"))
        )
    )


def _source_leg_length(rest: Float[np.ndarray, "j 3"], joints: dict[str, int], field: str) -> float:
    length = float(
        sum(
            np.linalg.norm(rest[joints[f"{side}_{lower}"]] - rest[joints[f"{side}_{upper}"]])
            for side in ("left", "right")
            for upper, lower in (("thigh", "shin"), ("shin", "foot"))
        )
    )
    if not 0.0 < length < np.inf:
        raise _no_rest(field, "its legs have no length, or none that is finite")
    return length


def _poses(
    rig: Rig,
    clip: BvhClip,
    rest: Float[np.ndarray, "j 3"],
    joints: dict[str, int],
    rotations: Float[np.ndarray, "t j 3 3"],
    axes: Float[np.ndarray, "3 3"],
) -> Float[np.ndarray, "t p 3"]:
    turned = np.empty((len(rotations), len(rig.part_names), 3, 3))
    poses = np.zeros((len(rotations), len(rig.part_names), 3))
    for part, name in enumerate(rig.part_names):
        parent = rig.part_parent[part]
        if name not in joints:
            turned[:, part] = turned[:, parent]
            continue
        alignment = _alignment(rig, clip, rest, joints, name, axes)
        turned[:, part] = rotations[:, joints[name]] @ alignment
        local = turned[:, part]
        if parent >= 0:
            local = turned[:, parent].transpose(0, 2, 1) @ local
        poses[:, part] = rotation_vectors(local)
    return poses


_NEXT = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shin", "shin": "foot"}


def _alignment(
    rig: Rig,
    clip: BvhClip,
    rest: Float[np.ndarray, "j 3"],
    joints: dict[str, int],
    part: str,
    axes: Float[np.ndarray, "3 3"],
) -> Float[np.ndarray, "3 3"]:
    """A: the person's part at rest to the source's."""
    side, _, limb = part.partition("_")
    if limb == "hand":
        return _alignment(rig, clip, rest, joints, f"{side}_forearm", axes)
    if limb == "foot":
        return _foot_alignment(clip, rest, joints, side, axes)
    if limb not in _NEXT:
        return np.eye(3)
    end = f"{side}_{_NEXT[limb]}"
    bone = rest[joints[end]] - rest[joints[part]]
    if not bone.any():
        return np.eye(3)
    return shortest_rotation(rig.bone(part, end), bone)


def _foot_alignment(
    clip: BvhClip,
    rest: Float[np.ndarray, "j 3"],
    joints: dict[str, int],
    side: str,
    axes: Float[np.ndarray, "3 3"],
) -> Float[np.ndarray, "3 3"]:
    """The tilt of a rest foot that leans with a splayed leg; none if it stands flat.

    The bone to the toes, looked at from the front, points straight down on a foot that is flat,
    and along the shin on one that was made in the shin's frame.
    """
    ankle = joints[f"{side}_foot"]
    shin = rest[ankle] - rest[joints[f"{side}_shin"]]
    bones = [clip.offsets[child] for child in np.flatnonzero(clip.parent == ankle)]
    bones += [clip.ends[end] for end in np.flatnonzero(clip.end_parent == ankle)]
    if not bones or not shin.any():
        return np.eye(3)
    toes = axes @ max(bones, key=lambda bone: float(np.linalg.norm(bone)))
    lean = np.arctan2(shin[0], -shin[1])
    toes_lean = np.arctan2(toes[0], -toes[1])
    apart = abs(np.degrees(toes_lean - lean))
    if toes[1] >= 0.0 or apart > _TILTED_FOOT_DEG:
        return np.eye(3)
    return shortest_rotation(_DOWN, np.array([shin[0], shin[1], 0.0]))


def _facing_forward(pelvis: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    """The turn about the vertical that makes a pelvis face forward."""
    forward = pelvis[:, 2]
    return rotation_matrices(np.array([[0.0, -np.arctan2(forward[0], forward[2]), 0.0]]))[0]


def _no_rest(field: str, why: str) -> InvalidInputError:
    return InvalidInputError(
        code="bvh-skeleton-unknown",
        field=field,
        reason=f"The skeleton at rest is no upright person: {why}.",
        remedy="Export the motion with a rest pose that stands, such as a T-pose.",
    )
