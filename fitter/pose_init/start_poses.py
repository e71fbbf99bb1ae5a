"""The few most plausible readings of all limbs together.

Given the trunk's reading, arms and legs are independent, so the plausibility of a whole body is a
sum: at most sixteen trunks, each with four chains of four readings, are ranked exactly by adding
energies. Readings that contradict the caller are not tried.

A bone's direction does not determine its twist. Elbow and knee are hinges, so where the chain is
bent the plane of the bend gives the twist of the upper limb: the hinge lies along upper × lower,
knees bend backward and elbows forward. Where the chain is nearly straight that plane is noise, and
the twist stays at the prior's mean.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.body.pose_prior import PosePrior, joint_energy, mean_pose
from fitter.body.scape import CAMERA_AXES
from fitter.numerics.rotations import (
    cross_products,
    rotation_matrices,
    rotation_vectors,
    swings,
    turns,
    unit_vectors,
)
from fitter.pose_init.click_problem import TRUNK_LEAN_SPREAD, TRUNK_YAW_SPREAD
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.lifting import FAR, NEAR, Lifting, LimbEnds
from fitter.pose_init.limbs import (
    CHAINS,
    PELVIS_MIDDLE,
    TORSO,
    Limb,
    limb_direction_at_rest,
    limb_named,
    point_at_rest,
)
from fitter.pose_init.trunk import Pixels, TrunkReadings, trunk_readings
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
    """Whether to keep each of the two readings."""
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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StartPoses:
    """Closed-form poses, best first.

    Attributes
    ----------
    pose
        (b, p, 3) radians.
    translation
        (b, 3) root joint in the camera frame, metres.
    energy
        (b,) half a sum of squares of priors and of how much too long limbs appear.
    """

    pose: Float[np.ndarray, "b p 3"]
    translation: Float[np.ndarray, "b 3"]
    energy: Float[np.ndarray, " b"]


def start_poses(
    rig: LandmarkRig,
    prior: PosePrior,
    lifting: Lifting,
    pixels: Pixels,
    lengths_m: Mapping[str, float],
    reference: Limb,
    *,
    limb_facing: Mapping[str, Facing],
    count: int,
) -> StartPoses:
    """Lift the clicks in every way they allow and keep the ``count`` most plausible.

    Parameters
    ----------
    pixels
        Limb ends by point name; the trunk's corners and middles must be there.
    reference
        The limb taken as parallel to the image.
    """
    trunks = trunk_readings(rig, lifting, pixels, lengths_m, reference)
    spine, chest = rig.part("spine"), rig.part("chest")
    bend = 0.5 * rotation_vectors(np.matmul(trunks.pelvis.transpose(0, 2, 1), trunks.chest))
    energy = _trunk_energy(trunks, limb_facing.get(TORSO))
    energy = energy + joint_energy(prior, spine, bend) + joint_energy(prior, chest, bend)
    chains = [
        chain_readings(
            rig,
            prior,
            lifting,
            pixels,
            lengths_m,
            chain=chain,
            root=trunks.points[limb_named(chain[0]).proximal],
            parent_rotation=trunks.chest if chain[0].endswith("arm") else trunks.pelvis,
            limb_facing=limb_facing,
        )
        for chain in CHAINS
    ]
    trunk, picks = _best(trunks, energy, chains, count)
    pose = np.tile(mean_pose(prior), (len(trunk), 1, 1))
    pose[:, 0] = rotation_vectors(trunks.pelvis[trunk])
    pose[:, spine] = pose[:, chest] = bend[trunk]
    total = energy[trunk]
    for (upper, lower), chain, pick in zip(CHAINS, chains, picks, strict=True):
        at = (trunk, pick // 2, pick % 2)
        pose[:, rig.part(upper)] = chain.upper[at]
        pose[:, rig.part(lower)] = chain.lower[at]
        total = total + chain.energy[at]
    arm = point_at_rest(rig, PELVIS_MIDDLE) - rig.rest_joints[0]
    return StartPoses(
        pose=pose,
        translation=trunks.points[PELVIS_MIDDLE][trunk]
        - (trunks.pelvis[trunk] @ arm) * CAMERA_AXES,
        energy=total,
    )


def _trunk_energy(trunks: TrunkReadings, facing: Facing | None) -> Float[np.ndarray, " g"]:
    lean = trunks.pelvis[:, 2, 1] / TRUNK_LEAN_SPREAD
    yaw = trunks.pelvis[:, 2, 0] / TRUNK_YAW_SPREAD
    excess = trunks.overreach_m / OVERREACH_SPREAD_M
    energy = 0.5 * (lean**2 + yaw**2 + excess**2)
    if facing is None:
        return energy
    wanted = NEAR if facing is Facing.TOWARD else FAR
    return np.where(trunks.facings.torso == wanted, energy, np.inf)


def _best(
    trunks: TrunkReadings,
    trunk_energy: Float[np.ndarray, " g"],
    chains: list[ChainReadings],
    count: int,
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Trunk and reading of each chain in the combinations to keep, in ascending order of energy.

    First the best; then, for the torso and for each limb, the best with that one facing the other
    way, so that every ambiguity is represented; then the next best.
    """
    total = trunk_energy
    for chain in chains:
        total = total[..., None] + chain.energy.reshape(
            len(trunk_energy), *[1] * (total.ndim - 1), 4
        )
    facings = _facing_bits(trunks.facings.torso)
    flat = total.ravel()
    order = np.argsort(flat, kind="stable")[: int(np.isfinite(flat).sum())]
    best = order[0]
    opposed = facings != facings[:, best : best + 1]
    chosen = [best, *(order[row[order]][0] for row in opposed if row[order].any())]
    chosen = list(dict.fromkeys([*chosen, *order[:count]]))[:count]
    chosen.sort(key=lambda index: flat[index])
    trunk, *picks = np.unravel_index(chosen, total.shape)
    return trunk, list(picks)


def _facing_bits(torso: Integer[np.ndarray, " g"]) -> Integer[np.ndarray, "nine combinations"]:
    """NEAR or FAR of the torso and of both limbs of each chain, by combination."""
    shape = (len(torso), *[4] * len(CHAINS))
    index = np.indices(shape).reshape(len(shape), -1)
    bits = [torso[index[0]]]
    for pick in index[1:]:
        bits += [pick // 2, pick % 2]
    return np.stack(bits)
