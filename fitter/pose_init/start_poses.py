"""The few most plausible readings of all limbs together.

Given the trunk's reading, arms and legs are independent, so the plausibility of a whole body is a
sum: at most sixteen trunks, each with four chains of four readings, are ranked exactly by adding
energies. Readings that contradict the caller are not tried.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.body.pose_prior import PosePrior, joint_energy, mean_pose
from fitter.body.scape import CAMERA_AXES
from fitter.numerics.rotations import rotation_vectors
from fitter.pose_init.chains import OVERREACH_SPREAD_M, ChainReadings, chain_readings
from fitter.pose_init.click_problem import TRUNK_LEAN_SPREAD, TRUNK_YAW_SPREAD
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.lifting import FAR, NEAR, Lifting
from fitter.pose_init.limbs import CHAINS, PELVIS_MIDDLE, TORSO, Limb, limb_named, point_at_rest
from fitter.pose_init.trunk import Pixels, TrunkReadings, trunk_readings
from fitter.vocabulary.choices import Facing


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
