"""What the detector says about limbs' slants, in metres on the person being fitted."""

import numpy as np

from fitter.arrays import Shape
from fitter.energies.limb_slants import SlantEvidence
from fitter.fits.prepared_model import PreparedModel
from fitter.observation.observation import Observation
from fitter.pose_init.landmark_rig import landmark_rig
from fitter.pose_init.limbs import limb_reaches


def limb_slants(
    observation: Observation, prepared: PreparedModel, shape: Shape
) -> SlantEvidence | None:
    """Slants of the limbs whose two ends are among the clicks; None if there are none.

    ``shape`` (n,) gives the limbs' lengths.
    """
    if observation.slants is None:
        return None
    names = list(observation.clicks)
    rig = landmark_rig(prepared.searched.model, shape)
    reaches = limb_reaches(observation.slants, rig, observation.camera, points=names)
    if not reaches.limbs:
        return None
    return SlantEvidence(
        ends=np.array(
            [[names.index(limb.proximal), names.index(limb.distal)] for limb in reaches.limbs]
        ),
        toward=reaches.toward,
        reach_m=reaches.reach_m,
        sigma_m=reaches.sigma_m,
    )
