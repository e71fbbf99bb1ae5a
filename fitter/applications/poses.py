"""The skeleton of one person, poses by name, and poses spelled out part by part.

Named poses are a table of clinical angles, degrees from the anatomical position (upright, arms
hanging), as in :mod:`fitter.body.joint_limits`; the person's own skeleton turns them into rotation
vectors, so that an arm at 90 degrees is level on everybody.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose, Shape, Vector3
from fitter.body.joint_limits import range_of, side_of
from fitter.body.model import BodyModel, regress
from fitter.body.pose_prior import PosePrior, joint_angles, pose_prior
from fitter.body.shape_space import rest_vertices
from fitter.errors import InvalidInputError
from fitter.numerics.rotations import (
    cross_products,
    rotation_matrices,
    rotation_vectors,
    unit_vectors,
)

LIMIT_TOLERANCE_DEG = 15.0
"""Margin beyond the textbooks' ranges of motion (:mod:`fitter.body.joint_limits`): people vary, and
one rotation's components differ from a goniometer's successive angles."""

_DIRECTIONS = ("flexion", "abduction", "twist")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rig:
    """A person's kinematic chain, body frame, metres.

    Attributes
    ----------
    part_names, part_parent
        As in :class:`~fitter.body.model.BodyModel`.
    rest_joints
        (p, 3) where the joints of this shape are at rest.
    prior
        Anatomical axes and limits of its joints.
    """

    part_names: tuple[str, ...]
    part_parent: Integer[np.ndarray, " p"]
    rest_joints: Float[np.ndarray, "p 3"]
    prior: PosePrior

    def index(self, part: str) -> int:
        """Number of a part by its name."""
        return self.part_names.index(part)

    def bone(self, part: str, end: str) -> Float[np.ndarray, "3"]:
        """From the joint of one part to that of another, at rest."""
        return self.rest_joints[self.index(end)] - self.rest_joints[self.index(part)]


def rig_of(model: BodyModel, shape: Shape) -> Rig:
    """The skeleton of a shape."""
    rest_joints = regress(model.joint_regressor, rest_vertices(model, shape))
    return Rig(
        part_names=model.part_names,
        part_parent=model.part_parent,
        rest_joints=rest_joints,
        prior=pose_prior(model.part_names, model.part_parent, rest_joints),
    )


def beyond_limits(rig: Rig, pose: Pose) -> str | None:
    """Which part is turned too far, which way and what its range is; None if none is.

    The angles are named as in :mod:`fitter.body.joint_limits`, relative to the rest pose.
    """
    angles = joint_angles(rig.prior, pose)
    tolerance = np.radians(LIMIT_TOLERANCE_DEG)
    low, high = rig.prior.lower - tolerance, rig.prior.upper + tolerance
    excess = np.maximum(angles - high, low - angles)
    part, direction = np.unravel_index(np.argmax(excess), excess.shape)
    if excess[part, direction] <= 0.0:
        return None
    found, least, most = (
        float(np.degrees(values[part, direction])) for values in (angles, low, high)
    )
    return (
        f"{rig.part_names[part]} is turned by {found:.0f} degrees of {_DIRECTIONS[direction]} from "
        f"the rest pose; its joint allows {least:.0f} to {most:.0f}"
    )


REST = "rest"
"""The pose of the model's own mesh, with half-raised arms: rotations spelled out begin from it."""

FULL_TURN = 2.0 * np.pi

_OPPOSITE = 1e-9
_NEARLY_ONE = 0.99


@dataclass(frozen=True, slots=True, kw_only=True)
class Angles:
    """Angles of a part, degrees: flexion, then abduction (arms, legs), then twist."""

    flexion: float = 0.0
    abduction: float = 0.0
    twist: float = 0.0


def _both(limb: str, angles: Angles) -> dict[str, Angles]:
    return {f"left_{limb}": angles, f"right_{limb}": angles}


_STANDING = (
    _both("upper_arm", Angles(flexion=2, abduction=9))
    | _both("forearm", Angles(flexion=12))
    | _both("thigh", Angles(abduction=3, twist=6))
    | _both("shin", Angles(flexion=2))
    | _both("foot", Angles())
)

NAMED_POSES: Mapping[str, Mapping[str, Angles]] = MappingProxyType(
    {
        "standing": _STANDING,
        "a_pose": _STANDING
        | _both("upper_arm", Angles(abduction=45))
        | _both("forearm", Angles(flexion=5))
        | _both("thigh", Angles(abduction=8)),
        "t_pose": _STANDING
        | _both("upper_arm", Angles(abduction=90))
        | _both("forearm", Angles())
        | _both("thigh", Angles(abduction=3)),
        "relaxed": _STANDING
        | {
            "spine": Angles(abduction=-3),
            "chest": Angles(flexion=3, abduction=4),
            "head": Angles(flexion=3, twist=8),
            "left_upper_arm": Angles(flexion=6, abduction=10),
            "right_upper_arm": Angles(flexion=-4, abduction=9),
            "left_forearm": Angles(flexion=28),
            "right_forearm": Angles(flexion=18),
            "left_thigh": Angles(flexion=14, abduction=8, twist=14),
            "left_shin": Angles(flexion=22),
            "left_foot": Angles(flexion=8),
            "right_thigh": Angles(abduction=-1, twist=4),
        },
        "walking": _STANDING
        | {
            "spine": Angles(flexion=3, twist=4),
            "chest": Angles(twist=6),
            "left_upper_arm": Angles(flexion=-24, abduction=9),
            "right_upper_arm": Angles(flexion=22, abduction=8),
            "left_forearm": Angles(flexion=15),
            "right_forearm": Angles(flexion=32),
            "left_thigh": Angles(flexion=25, abduction=1),
            "left_shin": Angles(flexion=6),
            "left_foot": Angles(flexion=2),
            "right_thigh": Angles(flexion=-16, abduction=1),
            "right_shin": Angles(flexion=18),
            "right_foot": Angles(flexion=-8),
        },
        "sitting": _both("upper_arm", Angles(flexion=28, abduction=12))
        | _both("forearm", Angles(flexion=62))
        | _both("hand", Angles(flexion=-8))
        | _both("thigh", Angles(flexion=86, abduction=5, twist=9))
        | _both("shin", Angles(flexion=86))
        | _both("foot", Angles())
        | {"spine": Angles(flexion=6)},
        "arms_raised": _STANDING
        | _both("upper_arm", Angles(abduction=155))
        | _both("forearm", Angles(flexion=14)),
    }
)
"""By name, then by part; parts that are not named are held as at rest."""


def named_pose(rig: Rig, name: str) -> Pose:
    """A pose of the table for a person's skeleton.

    Raises
    ------
    InvalidInputError
        If there is no pose of this name.
    """
    if name not in NAMED_POSES:
        known = ", ".join(sorted(NAMED_POSES))
        raise InvalidInputError(
            code="pose-unknown",
            field="pose",
            reason=f"There is no pose called {name!r}.",
            remedy=f"Take one of {known}, or spell the rotations out.",
        )
    return angled_pose(rig, NAMED_POSES[name])


def angled_pose(rig: Rig, angles: Mapping[str, Angles]) -> Pose:
    """Clinical angles by part as rotation vectors; parts left out stay as at rest."""
    pose = np.zeros((len(rig.part_names), 3))
    for part, held in angles.items():
        index = rig.index(part)
        if part.endswith(("upper_arm", "thigh")):
            pose[index] = _swung(rig, part, held)
        else:
            wanted = np.radians([held.flexion, held.abduction, held.twist])
            wanted -= _rest_angles(rig, part)
            pose[index] = rig.prior.axes[index].T @ wanted
    return pose


def spelled_pose(
    rig: Rig, rotations: Mapping[str, Sequence[float]], *, beginning: Pose | None = None
) -> Pose:
    """A pose from rotations by part, checked.

    Parameters
    ----------
    rig
        The person's skeleton.
    rotations
        By part name, relative to its parent in the axes of the rest body (body frame: x to the
        person's left, y up, z forward): three numbers are a rotation vector in radians, four a
        quaternion (x, y, z, w).
    beginning
        The pose of all other parts; the rest pose if None.

    Raises
    ------
    InvalidInputError
        If a part is unknown, a rotation has another length, is not finite, is longer than a whole
        turn or no rotation, or turns a joint farther than joints turn.
    """
    pose = np.zeros((len(rig.part_names), 3)) if beginning is None else beginning.copy()
    for part, numbers in rotations.items():
        if part not in rig.part_names:
            raise _refused(
                part=part,
                reason="There is no part of this name.",
                remedy=f"The parts are {', '.join(rig.part_names)}.",
            )
        pose[rig.index(part)] = _rotation_vector(part, numbers)
    fault = beyond_limits(rig, pose)
    if fault is not None:
        part = fault.split(" ", 1)[0]
        raise _refused(part=part, reason=f"{fault}.", remedy="Turn it less.")
    return pose


def _swung(rig: Rig, part: str, held: Angles) -> Vector3:
    """A limb's root turned so that its bone points where flexion and abduction say.

    The bone hangs down, is abducted about the body's z axis and then flexed about its x axis; the
    rest bone is brought there the short way and twisted about itself before. Components of one
    rotation vector would not do: beyond 90 degrees they swing an arm behind the head.
    """
    side = side_of(part)
    hanging = np.array([0.0, -1.0, 0.0])
    turns = np.radians([[0.0, 0.0, side * held.abduction], [-held.flexion, 0.0, 0.0]])
    abducted, flexed = rotation_matrices(turns)
    index = rig.index(part)
    end = part.replace("upper_arm", "forearm").replace("thigh", "shin")
    swing = shortest_rotation(rig.bone(part, end), flexed @ abducted @ hanging)
    twist = rotation_matrices(np.radians(held.twist) * rig.prior.axes[index, 2:3])[0]
    return rotation_vectors((swing @ twist)[None])[0]


def shortest_rotation(start: Vector3, end: Vector3) -> Float[np.ndarray, "3 3"]:
    """The rotation by the least angle from one direction to another.

    Of opposite directions every axis across them will do: the one nearest to the body's z.
    """
    first, second = unit_vectors(np.stack([start, end]))
    axis = cross_products(first, second)
    sine = float(np.linalg.norm(axis))
    angle = np.arctan2(sine, float(first @ second))
    if sine < _OPPOSITE and angle > 1.0:
        nearest = np.eye(3)[1 if abs(first[2]) > _NEARLY_ONE else 2]
        axis = nearest - (nearest @ first) * first
        sine = float(np.linalg.norm(axis))
    return rotation_matrices((axis * (angle / sine if sine > 0.0 else 0.0))[None])[0]


def _rest_angles(rig: Rig, part: str) -> Vector3:
    """Clinical angles a part has at rest, radians; the prior's means are relative to them."""
    joint = range_of(part)
    if joint is None:
        return np.zeros(3)
    means = [motion.mean for motion in (joint.flexion, joint.abduction, joint.twist)]
    return np.radians(means) - rig.prior.mean[rig.index(part)]


def _rotation_vector(part: str, numbers: Sequence[float]) -> Vector3:
    values = np.asarray(numbers, dtype=np.float64)
    if values.shape not in ((3,), (4,)):
        raise _refused(
            part=part,
            reason=f"A rotation has 3 or 4 numbers, this one has {values.size}.",
            remedy="Send a rotation vector in radians, or a quaternion as x, y, z, w.",
        )
    if not np.isfinite(values).all():
        raise _refused(
            part=part, reason="A number is not finite.", remedy="Send finite numbers only."
        )
    length = float(np.linalg.norm(values))
    if len(values) == 3:
        if length > FULL_TURN:
            raise _refused(
                part=part,
                reason=f"The rotation vector is {length:.4g} long, more than a whole turn.",
                remedy="Send radians, not degrees.",
            )
        return rotation_vectors(rotation_matrices(values[None]))[0]
    if abs(length - 1.0) > 1e-2:
        raise _refused(
            part=part,
            reason=f"The quaternion is {length:.4g} long, not 1.",
            remedy="Send a unit quaternion as x, y, z, w.",
        )
    imaginary, real = values[:3], values[3]
    sine = float(np.linalg.norm(imaginary))
    angle = 2.0 * np.arctan2(sine, abs(real)) * (1.0 if real >= 0.0 else -1.0)
    return imaginary * (angle / sine if sine > 0.0 else 0.0)


def _refused(*, part: str, reason: str, remedy: str) -> InvalidInputError:
    return InvalidInputError(
        code="rotation-unusable", field=f"rotations.{part}", reason=reason, remedy=remedy
    )
