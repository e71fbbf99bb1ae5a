"""What the detector says about limbs' slants, in metres on the person being fitted."""

import numpy as np

from fitter.arrays import Shape
from fitter.energies.limb_slants import SlantEvidence
from fitter.fits.prepared_model import PreparedModel
from fitter.observation.observation import Observation
from fitter.pose_init.landmark_rig import landmark_rig
from fitter.pose_init.limbs import limb_lengths_m, limb_named


def limb_slants(
    observation: Observation, prepared: PreparedModel, shape: Shape
) -> SlantEvidence | None:
    """Slants of the limbs whose two ends are among the clicks; None if there are none.

    ``shape`` (n,) gives the limbs' lengths.
    """
    slants = observation.slants
    if slants is None:
        return None
    names = list(observation.clicks)
    limbs = [
        limb
        for limb in map(limb_named, slants.limbs)
        if limb.proximal in names and limb.distal in names
    ]
    if not limbs:
        return None
    lengths = limb_lengths_m(landmark_rig(prepared.operators.model, shape))
    told = [(slants.limbs[limb.name], lengths[limb.name]) for limb in limbs]
    ray = observation.camera.rays(slants.middle)
    return SlantEvidence(
        ends=np.array([[names.index(limb.proximal), names.index(limb.distal)] for limb in limbs]),
        toward=ray / np.linalg.norm(ray),
        reach_m=np.array([length * slant.sine for slant, length in told]),
        sigma_m=np.array([length * slant.sigma for slant, length in told]),
    )
