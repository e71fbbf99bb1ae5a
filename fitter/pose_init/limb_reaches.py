"""What the detector says of limbs' slants, as metres along the view on a person of known limbs."""

from collections.abc import Collection, Container
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.detection.detector import DetectedSlants
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.limbs import Limb, limb_lengths_m, limb_named
from fitter.render.camera import Camera

TRUNCATION = 1.5
"""Standard deviations beyond which a slant is trusted less and less: one in twenty is wrong."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LimbReaches:
    """How much farther along the view the far ends of limbs lie than the near ones.

    Attributes
    ----------
    limbs
        s limbs, both of whose ends are known points.
    toward
        (3,) unit vector from the camera to the person, camera frame.
    reach_m, sigma_m
        (s,) how much farther, and its standard deviation, metres.
    """

    limbs: tuple[Limb, ...]
    toward: Vector3
    reach_m: Float[np.ndarray, " s"]
    sigma_m: Float[np.ndarray, " s"]


def limb_reaches(
    slants: DetectedSlants,
    rig: LandmarkRig,
    camera: Camera,
    *,
    points: Collection[str],
    without: Container[str] = (),
) -> LimbReaches:
    """Reaches of the limbs of a rig whose two ends are among ``points``, but for some by name."""
    limbs = tuple(
        limb
        for limb in map(limb_named, slants.limbs)
        if limb.name not in without and limb.proximal in points and limb.distal in points
    )
    lengths = limb_lengths_m(rig)
    told = [(slants.limbs[limb.name], lengths[limb.name]) for limb in limbs]
    ray = camera.rays(slants.middle)
    return LimbReaches(
        limbs=limbs,
        toward=ray / np.linalg.norm(ray),
        reach_m=np.array([length * slant.sine for slant, length in told]),
        sigma_m=np.array([length * slant.sigma for slant, length in told]),
    )
