"""Arms and legs: every reading of a two-limb chain, as joint rotations with their plausibility.

A bone's direction does not determine its twist. Elbow and knee are hinges, so where the chain is
bent the plane of the bend gives the twist of the upper limb: the hinge lies along upper × lower,
knees bend backward and elbows forward. Where the chain is nearly straight that plane is noise, and
the twist stays at the prior's mean.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from fitter.body.pose_prior import PosePrior, joint_energy, mean_pose
from fitter.body.scape import CAMERA_AXES
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.numerics.vectors import cross_products, unit_vectors
from fitter.pose_init.directions import swings, turns
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.lifting import FAR, NEAR, Lifting, LimbEnds
from fitter.pose_init.limbs import limb_direction_at_rest, limb_named
from fitter.pose_init.trunk import Pixels
from fitter.vocabulary.choices import Facing

OVERREACH_SPREAD_M = 0.03
"""Standard deviation of how much too long a limb may appear: its length is only predicted."""

_STRAIGHT, _BENT = 0.15, 0.5
"""Sines of the bend below which its plane is ignored, and above which it is fully trusted."""

_DISTINCT = 0.15
"""Two readings of a limb count as one if their ends are closer than this share of its length."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ChainReadings:
    """Readings of one chain for each of g trunks: upper limb NEAR, FAR x lower limb NEAR, FAR.

    Attributes
    ----------
    upper, lower
        (g, 2, 2, 3) rotation vectors of the two parts relative to their parents, radians.
    energy
        (g, 2, 2) half a sum of squares of the prior and of overreach; infinite where the reading
        contradicts the caller or repeats another.
    """

    upper: Float[np.ndarray, "g 2 2 3"]
    lower: Float[np.ndarray, "g 2 2 3"]
    energy: Float[np.ndarray, "g 2 2"]


def chain_readings(
    rig: LandmarkRig,
    prior: PosePrior,
    lifting: Lifting,
    pixels: Pixels,
    lengths_m: Mapping[str, float],
    *,
    chain: tuple[str, str],
    root: Float[np.ndarray, "g 3"],
    parent_rotation: Float[np.ndarray, "g 3 3"],
    limb_facing: Mapping[str, Facing],
) -> ChainReadings:
    """Lift one chain from where it is attached to each trunk.

    Parameters
    ----------
    pixels
        Clicked limb ends by name; a chain without its middle stays at the prior's mean.
    chain
        Names of the upper and lower limb.
    root
        (g, 3) where the chain is attached, camera frame, metres.
    parent_rotation
        (g, 3, 3) global rotation of the part it is attached to, body frame axes.
    limb_facing
        Which way limbs face according to the caller.
    """
    g = len(root)
    upper, lower = (limb_named(name) for name in chain)
    upper_part, lower_part = (rig.part(name) for name in chain)
    mean = mean_pose(prior)
    shape = (g, 2, 2, 3)
    if upper.distal not in pixels:
        energy = np.full((g, 2, 2), np.inf)
        energy[:, NEAR, NEAR] = 0.0
        return ChainReadings(
            upper=np.broadcast_to(mean[upper_part], shape),
            lower=np.broadcast_to(mean[lower_part], shape),
            energy=energy,
        )
    first = lifting.reach(root, pixels[upper.distal], lengths_m[upper.name])
    excess = np.broadcast_to((first.overreach_m / OVERREACH_SPREAD_M)[:, None, None], (g, 2, 2))
    energy = 0.5 * excess**2
    allowed = _allowed(first, limb_facing.get(upper.name), lengths_m[upper.name])[:, :, None]
    along = _in_parent(parent_rotation, first.points - root[:, None])[:, :, None]
    if lower.distal in pixels:
        second = lifting.reach(first.points, pixels[lower.distal], lengths_m[lower.name])
        energy = energy + 0.5 * (second.overreach_m / OVERREACH_SPREAD_M)[:, :, None] ** 2
        allowed = allowed & _allowed(second, limb_facing.get(lower.name), lengths_m[lower.name])
        onward = _in_parent(parent_rotation, second.points - first.points[:, :, None])
    else:
        allowed = allowed & np.array([True, False])
        onward = None
    rest_along = unit_vectors(limb_direction_at_rest(rig, upper))
    rest_onward = unit_vectors(limb_direction_at_rest(rig, lower))
    means = rotation_matrices(mean[[upper_part, lower_part]])
    plain = np.matmul(swings(means[0] @ rest_along, along), means[0])
    if onward is None:
        upper_vectors = np.broadcast_to(_vectors(plain), shape)
        lower_vectors = np.broadcast_to(mean[lower_part], shape)
        energy = energy + joint_energy(prior, upper_part, upper_vectors)
    else:
        hinge = prior.axes[lower_part, 0]
        readings: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        for rotation in (
            np.broadcast_to(plain, (g, 2, 2, 3, 3)),
            _twisted_into_bend(plain, along, onward, hinge),
        ):
            carried = np.einsum("...ji,...j->...i", rotation, onward)
            lower_rotation = np.matmul(swings(means[1] @ rest_onward, carried), means[1])
            vectors = _vectors(rotation), _vectors(lower_rotation)
            cost = joint_energy(prior, upper_part, vectors[0]) + joint_energy(
                prior, lower_part, vectors[1]
            )
            readings.append((*vectors, cost))
        better = (readings[1][2] < readings[0][2])[..., None]
        upper_vectors = np.where(better, readings[1][0], readings[0][0])
        lower_vectors = np.where(better, readings[1][1], readings[0][1])
        energy = energy + np.minimum(readings[0][2], readings[1][2])
    return ChainReadings(
        upper=upper_vectors,
        lower=lower_vectors,
        energy=np.where(np.broadcast_to(allowed, energy.shape), energy, np.inf),
    )


def _twisted_into_bend(
    rotation: Float[np.ndarray, "g 2 1 3 3"],
    along: Float[np.ndarray, "g 2 1 3"],
    onward: Float[np.ndarray, "g 2 2 3"],
    hinge: Float[np.ndarray, "3"],
) -> Float[np.ndarray, "g 2 2 3 3"]:
    """Turn the upper limb about its bone until its hinge is perpendicular to the bend's plane."""
    wanted = cross_products(along, onward)
    sine = np.linalg.norm(wanted, axis=-1)
    carried = rotation @ hinge
    angle = np.arctan2(
        (along * cross_products(carried, wanted)).sum(axis=-1), (carried * wanted).sum(axis=-1)
    )
    belief = np.clip((sine - _STRAIGHT) / (_BENT - _STRAIGHT), 0.0, 1.0)
    return np.matmul(turns(np.broadcast_to(along, onward.shape), belief * angle), rotation)


def _allowed(ends: LimbEnds, facing: Facing | None, length_m: float) -> Bool[np.ndarray, "... 2"]:
    """Which of the two readings to keep."""
    shape = ends.points.shape[:-1]
    if facing is not None:
        kept = np.array([facing is Facing.TOWARD, facing is Facing.AWAY])
        return np.broadcast_to(kept, shape)
    gap = np.linalg.norm(ends.points[..., FAR, :] - ends.points[..., NEAR, :], axis=-1)
    distinct = gap > _DISTINCT * length_m
    return np.stack([np.ones_like(distinct), distinct], axis=-1)


def _in_parent(
    parent_rotation: Float[np.ndarray, "g 3 3"], camera_vectors: Float[np.ndarray, "g ... 3"]
) -> Float[np.ndarray, "g ... 3"]:
    """Unit directions in the parent part's frame from camera-frame vectors."""
    return np.einsum(
        "gji,g...j->g...i", parent_rotation, unit_vectors(camera_vectors * CAMERA_AXES)
    )


def _vectors(matrices: Float[np.ndarray, "... 3 3"]) -> Float[np.ndarray, "... 3"]:
    return rotation_vectors(matrices.reshape(-1, 3, 3)).reshape(matrices.shape[:-1])
