"""Motion of another skeleton on a person's own.

A part turns as the source's joint does: R_target = R_source A, with A from
:mod:`fitter.applications.alignment`, so that the pose which the file calls rest does not matter.
"""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from jaxtyping import Float, Integer

from fitter.applications.alignment import Samples, alignments
from fitter.applications.bvh import BvhFile
from fitter.applications.motion import Motion
from fitter.applications.motion_file import MotionFile
from fitter.applications.poses import Rig
from fitter.arrays import Vector3
from fitter.numerics.rotations import rotation_matrices, rotation_vectors, unit_vectors
from fitter.vocabulary.remarks import Note, Remark, remark

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


Axis = Literal["y", "-y", "z", "-z", "x", "-x"]
AXES: tuple[Axis, ...] = get_args(Axis)
"""In the order in which they are preferred: most files' up is y."""

_UPRIGHT_COSINE = np.cos(np.radians(45.0))

_MOST = 0.75
"""Share of frames upright along the best axis, below which up is in doubt."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class UpAxis:
    """The axis, its rotation to a world whose y is up, and a warning where it is in doubt."""

    axis: Axis
    to_world: Float[np.ndarray, "3 3"]
    warnings: tuple[Remark, ...]


def given_up_axis(axis: Axis) -> UpAxis:
    """The axis that the caller says is up."""
    return UpAxis(axis=axis, to_world=_to_world(axis), warnings=())


def found_up_axis(feet_to_head: Float[np.ndarray, "t 3"]) -> UpAxis:
    """The axis along which the head is above the feet in most of the frames.

    Parameters
    ----------
    feet_to_head
        From the middle of the feet to the head, in the file's axes.
    """
    towards = unit_vectors(feet_to_head)
    heights = np.stack([towards @ _direction(axis) for axis in AXES])
    shares = (heights > _UPRIGHT_COSINE).mean(axis=1)
    # Where no axis has upright frames, the one that is nearest on the whole.
    best = int(np.lexsort((-np.arange(len(AXES)), heights.mean(axis=1), shares))[-1])
    axis, share = AXES[best], float(shares[best])
    warnings: tuple[Remark, ...] = ()
    if axis != AXES[0] or share < _MOST:
        message = (
            f"Up was taken to be the file's {axis}: along it the head is above the feet in "
            f"{share:.0%} of the frames."
        )
        warnings = (remark(Note.UP_UNCERTAIN, message),)
    return UpAxis(axis=axis, to_world=_to_world(axis), warnings=warnings)


def _direction(axis: str) -> Vector3:
    return np.eye(3)["xyz".index(axis[-1])] * (-1.0 if axis.startswith("-") else 1.0)


def _to_world(axis: str) -> Float[np.ndarray, "3 3"]:
    up = _direction(axis)
    first = np.roll(np.abs(up), -1)
    return np.stack([first, up, np.cross(first, up)])


LIFT_DEAD_ZONE_M = 0.05
"""The source's lowest joint rises and falls by so much in walking, as heel and toe take turns: only
what goes beyond is taken for leaving the ground."""

GROUND_PERCENTILE = 10.0
"""Percentile of the lowest joint's height over the clip that is taken for the source's ground."""

MOST_SAMPLES = 500
"""Frames of the clip, evenly spread, from which up and the alignments follow."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Retargeted:
    """A source's motion on a person's skeleton.

    ``up`` is how the source's world stands, ``scale`` metres of the person by unit of the source's
    length.
    """

    motion: Motion
    up: UpAxis
    scale: float


def retarget(
    source: MotionFile, rig: Rig, frames: Integer[np.ndarray, " t"], *, up: Axis | None = None
) -> Retargeted:
    """Some frames of a file as poses of a person.

    The person faces forward in the first frame and begins above the origin.

    Parameters
    ----------
    source
        The file.
    rig
        The person's skeleton.
    frames
        Which frames, evenly spaced.
    up
        The file's axis that points up; found from the motion if None.
    """
    axis, samples = _world_and_samples(source, up)
    aligned = alignments(samples, rig)
    shown = stretch_of(source.clip, frames)
    rotations = axis.to_world @ shown.rotations
    turned = {part: rotations[:, source.joints[part]] @ a for part, a in aligned.items()}
    poses = _poses(rig, turned)
    scale = _leg_length(rig) / source.leg
    # The first place is taken off before scaling: a file's world may lie far from its origin.
    start = shown.positions[0, source.joints["pelvis"]]
    points = np.concatenate([shown.positions, shown.ends], axis=1)
    points = scale * (points - start) @ axis.to_world.T
    lowest = points[:, :, 1].min(axis=1)
    ground = float(np.percentile(lowest, GROUND_PERCENTILE))
    facing = _facing_forward(rotation_matrices(poses[:1, 0])[0])
    poses[:, 0] = rotation_vectors(facing @ rotation_matrices(poses[:, 0]))
    step = int(frames[1] - frames[0]) if len(frames) > 1 else 1
    return Retargeted(
        motion=Motion(
            frame_time_s=source.clip.frame_time_s * step,
            poses=poses,
            roots=(points[:, source.joints["pelvis"]] - [0.0, ground, 0.0]) @ facing.T,
            lifts_m=np.maximum(lowest - ground - LIFT_DEAD_ZONE_M, 0.0),
        ),
        up=axis,
        scale=scale,
    )


def _world_and_samples(source: MotionFile, up: Axis | None) -> tuple[UpAxis, Samples]:
    """The up axis of the file's world, and the frames of the clip from which A follows.

    They are of the whole clip, so that every stretch of it shows the same.
    """
    clip, joints = source.clip, source.joints
    count = min(clip.frames, MOST_SAMPLES)
    chosen = np.unique(np.linspace(0, clip.frames - 1, count).round().astype(np.int64))
    # Speeds are those to the next frame, and of the last frame those from the one before.
    earlier = np.minimum(chosen, max(clip.frames - 2, 0))
    later = np.minimum(earlier + 1, clip.frames - 1)
    at, before, after = (stretch_of(clip, frames) for frames in (chosen, earlier, later))
    head = next(part for part in ("head", "neck", "left_upper_arm") if part in joints)
    feet = 0.5 * (at.positions[:, joints["left_foot"]] + at.positions[:, joints["right_foot"]])
    axis = found_up_axis(at.positions[:, joints[head]] - feet) if up is None else given_up_axis(up)
    toes: dict[str, Float[np.ndarray, "t 3"]] = {}
    speed: dict[str, Float[np.ndarray, " t"]] = {}
    for side in ("left", "right"):
        ankle = joints[f"{side}_foot"]
        moved = after.positions[:, ankle] - before.positions[:, ankle]
        speed[side] = np.linalg.norm(moved, axis=1)
        point = _toes(source, ankle)
        if point is not None:
            toes[side] = _at(at, ankle, point) @ axis.to_world.T / source.leg
            moved = _at(after, ankle, point) - _at(before, ankle, point)
            speed[side] = np.maximum(speed[side], np.linalg.norm(moved, axis=1))
        speed[side] = speed[side] / (source.leg * clip.frame_time_s)
    return axis, Samples(
        rotations={part: axis.to_world @ at.rotations[:, j] for part, j in joints.items()},
        positions={
            part: at.positions[:, j] @ axis.to_world.T / source.leg for part, j in joints.items()
        },
        toes=toes,
        foot_speed=speed,
    )


def _toes(source: MotionFile, ankle: int) -> Float[np.ndarray, "3"] | None:
    """The longest bone that hangs on the ankle, in its frame; None without one of any length."""
    clip = source.clip
    bones = [clip.offsets[j] for j, parent in enumerate(clip.parents) if parent == ankle]
    bones += [clip.ends[e] for e, parent in enumerate(clip.end_parents) if parent == ankle]
    longest = max((np.array(bone) for bone in bones), key=np.linalg.norm, default=np.zeros(3))
    return longest if longest.any() else None


def _at(stretch: Stretch, joint: int, point: Float[np.ndarray, "3"]) -> Float[np.ndarray, "t 3"]:
    """Places of a point that is fixed to a joint."""
    return stretch.positions[:, joint] + stretch.rotations[:, joint] @ point


def _leg_length(rig: Rig) -> float:
    """Mean of both legs, metres."""
    return 0.5 * float(
        sum(
            np.linalg.norm(rig.bone(f"{side}_{upper}", f"{side}_{lower}"))
            for side in ("left", "right")
            for upper, lower in (("thigh", "shin"), ("shin", "foot"))
        )
    )


def _poses(
    rig: Rig, turned_parts: dict[str, Float[np.ndarray, "t 3 3"]]
) -> Float[np.ndarray, "t p 3"]:
    """Rotations relative to the parents'; a part that the source does not move stays straight."""
    count = len(turned_parts["pelvis"])
    turned = np.empty((count, len(rig.part_names), 3, 3))
    poses = np.zeros((count, len(rig.part_names), 3))
    for part, name in enumerate(rig.part_names):
        parent = rig.part_parent[part]
        if name not in turned_parts:
            turned[:, part] = turned[:, parent]
            continue
        turned[:, part] = turned_parts[name]
        local = turned[:, part]
        if parent >= 0:
            local = turned[:, parent].transpose(0, 2, 1) @ local
        poses[:, part] = rotation_vectors(local)
    return poses


def _facing_forward(pelvis: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    """The turn about the vertical that makes a pelvis face forward."""
    forward = pelvis[:, 2]
    return rotation_matrices(np.array([[0.0, -np.arctan2(forward[0], forward[2]), 0.0]]))[0]
