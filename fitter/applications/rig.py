"""The skeleton of one person: joints at rest, and what its joints may do."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose, Shape
from fitter.body.model import BodyModel, regress
from fitter.body.pose_prior import PosePrior, joint_angles, pose_prior
from fitter.body.shape_space import rest_vertices

LIMIT_TOLERANCE_DEG = 15.0
"""How far beyond the textbooks' ranges of motion (:mod:`fitter.body.joint_limits`) a part may be
turned: people vary, and one rotation's components differ from a goniometer's successive angles."""

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
