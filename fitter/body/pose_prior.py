"""The pose prior of a body: textbook ranges of motion expressed in its own rest pose.

A part's rotation vector, read along the part's anatomical axes, gives three angles: flexion,
abduction, twist (:mod:`fitter.body.joint_limits`). The axes come from the direction of the bone at
rest, and the angles are shifted by what the rest pose already has (arms held off the trunk,
slightly bent knees), so the same table serves any rest pose whose palms face the body.

For large turns the three numbers are components of one rotation and not the successive angles of
a goniometer; within the limits the difference stays below the tables' own rounding for hinges and
is accepted for shoulder and hip.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose
from fitter.body.joint_limits import LIMIT_SOFTNESS_DEG, range_of, side_of
from fitter.numerics.rotations import cross_products, inverse_left_jacobians, unit_vectors

_FORWARD = np.array([0.0, 0.0, 1.0])
_UP = np.array([0.0, 1.0, 0.0])
# Where the left palm faces at rest, with half-raised arms: to the body and down, thumb forward.
_LEFT_PALM = np.array([-0.74, -0.67, 0.0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PosePrior:
    """Mean, spread and limits of each joint's three angles, radians relative to the rest pose.

    Attributes
    ----------
    axes
        (p, 3, 3) rows are the flexion, abduction and twist axes in the body frame at rest:
        angles = axes[j] @ pose[j].
    mean, lower, upper
        (p, 3); limits are infinite for the root.
    precision
        (p, 3) one over the standard deviation; zero for the root.
    """

    axes: Float[np.ndarray, "p 3 3"]
    mean: Pose
    precision: Pose
    lower: Pose
    upper: Pose


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PriorTerms:
    """Residuals of the prior and their Jacobian; the energy is half their sum of squares.

    Attributes
    ----------
    residuals
        (..., p, 6): departures from the mean in standard deviations, then excursions beyond the
        limits in units of their softness, for flexion, abduction and twist.
    jacobian
        (..., p, 6, 3): by increments δ of the same joint, applied as exp(δ) exp(pose).
    """

    residuals: Float[np.ndarray, "... p 6"]
    jacobian: Float[np.ndarray, "... p 6 3"]


def pose_prior(
    part_names: tuple[str, ...],
    part_parent: Integer[np.ndarray, " p"],
    rest_joints: Float[np.ndarray, "p 3"],
) -> PosePrior:
    """Express the table of ranges in a body's rest pose.

    Parameters
    ----------
    part_names, part_parent
        The kinematic chain.
    rest_joints
        (p, 3) rest positions of the joints, body frame, metres.
    """
    p = len(part_names)
    mean, precision = np.zeros((p, 3)), np.zeros((p, 3))
    lower, upper = np.full((p, 3), -np.inf), np.full((p, 3), np.inf)
    bones = _bone_directions(part_names, part_parent, rest_joints)
    axes = _anatomical_axes(part_names, bones)
    for part, name in enumerate(part_names):
        joint = range_of(name)
        if joint is None:
            continue
        at_rest = _angles_at_rest(name, axes[part], bones[part], bones[part_parent[part]])
        motions = (joint.flexion, joint.abduction, joint.twist)
        mean[part] = np.radians([m.mean for m in motions]) - at_rest
        precision[part] = 1.0 / np.radians([m.standard_deviation for m in motions])
        lower[part] = np.radians([m.lower for m in motions]) - at_rest
        upper[part] = np.radians([m.upper for m in motions]) - at_rest
    return PosePrior(axes=axes, mean=mean, precision=precision, lower=lower, upper=upper)


def joint_angles(
    prior: PosePrior, pose: Float[np.ndarray, "... p 3"]
) -> Float[np.ndarray, "... p 3"]:
    """Flexion, abduction and twist of every joint, radians relative to the rest pose."""
    return np.matmul(prior.axes, pose[..., None])[..., 0]


def mean_pose(prior: PosePrior) -> Pose:
    """The prior's mean as a pose; the root does not turn."""
    return np.einsum("pai,pa->pi", prior.axes, prior.mean)


def prior_residuals(
    prior: PosePrior, pose: Float[np.ndarray, "... p 3"]
) -> Float[np.ndarray, "... p 6"]:
    """The residuals of :class:`PriorTerms` alone."""
    angles = joint_angles(prior, pose)
    departures = prior.precision * (angles - prior.mean)
    return np.concatenate([departures, _beyond(angles, prior.lower, prior.upper)], axis=-1)


def prior_energy(prior: PosePrior, pose: Pose) -> float:
    """Half the sum of squared residuals, nats."""
    return 0.5 * float((prior_residuals(prior, pose) ** 2).sum())


def prior_terms(prior: PosePrior, pose: Float[np.ndarray, "... p 3"]) -> PriorTerms:
    """Residuals and Jacobian of the prior, for one pose or a batch of them."""
    residuals = prior_residuals(prior, pose)
    slope = np.where(residuals[..., 3:] != 0.0, 1.0 / np.radians(LIMIT_SOFTNESS_DEG), 0.0)
    turned = np.matmul(prior.axes, inverse_left_jacobians(pose))
    return PriorTerms(
        residuals=residuals,
        jacobian=np.concatenate(
            [prior.precision[..., None] * turned, slope[..., None] * turned], axis=-2
        ),
    )


def joint_energy(
    prior: PosePrior, part: int, vectors: Float[np.ndarray, "... 3"]
) -> Float[np.ndarray, "..."]:
    """Half the sum of squared residuals of one joint turned by these rotation vectors."""
    angles = vectors @ prior.axes[part].T
    departures = prior.precision[part] * (angles - prior.mean[part])
    beyond = _beyond(angles, prior.lower[part], prior.upper[part])
    return 0.5 * (departures**2 + beyond**2).sum(axis=-1)


def _beyond(
    angles: Float[np.ndarray, "..."],
    lower: Float[np.ndarray, "..."],
    upper: Float[np.ndarray, "..."],
) -> Float[np.ndarray, "..."]:
    """Excursions beyond the limits, in units of their softness."""
    excursion = np.maximum(angles - upper, 0.0) + np.minimum(angles - lower, 0.0)
    return excursion / np.radians(LIMIT_SOFTNESS_DEG)


def _bone_directions(
    part_names: tuple[str, ...],
    part_parent: Integer[np.ndarray, " p"],
    rest_joints: Float[np.ndarray, "p 3"],
) -> Float[np.ndarray, "p 3"]:
    """Unit direction of each part's bone at rest: to its child, or by anatomy at the ends.

    Of several children (arms and neck of the chest, thighs and spine of the pelvis) the one that
    continues the trunk counts.
    """
    bones = np.tile(_UP, (len(part_names), 1))
    for part, name in enumerate(part_names):
        if name.endswith("foot"):
            bones[part] = _FORWARD
        elif name.endswith("hand"):
            bones[part] = bones[part_parent[part]]
        elif name != "head":
            children = [
                child
                for child in np.flatnonzero(part_parent == part)
                if side_of(part_names[child]) == side_of(name)
            ]
            if children:
                bone = rest_joints[children[0]] - rest_joints[part]
                bones[part] = bone / np.linalg.norm(bone)
    return bones


def _anatomical_axes(
    part_names: tuple[str, ...], bones: Float[np.ndarray, "p 3"]
) -> Float[np.ndarray, "p 3 3"]:
    """Flexion, abduction and twist axes; right axes mirror left ones.

    A hand flexes to its palm and abducts to its thumb; other limbs flex forward (shins backward)
    and abduct away from the middle.
    """
    side = np.array([side_of(name) for name in part_names])[:, None]
    hand = np.array([name.endswith("hand") for name in part_names])
    toward = np.tile(_FORWARD, (len(part_names), 1))
    toward[[name.endswith("shin") for name in part_names]] = -_FORWARD
    toward[[name.endswith("foot") for name in part_names]] = _UP
    toward[hand] = _LEFT_PALM * np.where(side[hand] < 0, [-1.0, 1.0, 1.0], 1.0)
    flexion = unit_vectors(cross_products(bones, toward))
    abduction = cross_products(flexion, bones)
    moved = cross_products(abduction, bones)
    outward = moved[:, :1] * np.where(side < 0, -1.0, 1.0)
    away = np.where(hand[:, None], moved[:, 2:], outward)
    abduction = np.where(away < 0.0, -abduction, abduction)
    twist = np.where(side == 0, bones, -side * bones)
    return np.stack([flexion, abduction, twist], axis=1)


def _angles_at_rest(
    name: str,
    axes: Float[np.ndarray, "3 3"],
    bone: Float[np.ndarray, "3"],
    parent_bone: Float[np.ndarray, "3"],
) -> Float[np.ndarray, "3"]:
    """Clinical angles the rest pose already has, radians.

    A hinge's sideways angle at rest is its natural one (the elbow's carrying angle) and counts 0.
    """
    if name.endswith(("upper_arm", "thigh")):
        flexion = np.arctan2(bone[2], np.hypot(bone[0], bone[1]))
        abduction = np.arctan2(side_of(name) * bone[0], -bone[1])
        return np.array([flexion, abduction, 0.0])
    if name.endswith(("forearm", "shin")):
        turn = cross_products(parent_bone, bone)
        sine = turn @ axes[0]
        return np.array([np.arctan2(sine, bone @ parent_bone), 0.0, 0.0])
    return np.zeros(3)
