"""Slant energy: how far limbs extend along the view, as the detector estimates it.

A picture shows a limb foreshortened, and tells neither how much of that is due to the limb's own
length nor whether it leans toward the camera or away; a network that has seen many people does.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points3D, Vector3
from fitter.energies.rows import PositionRows, Support
from fitter.numerics.robust import huber, huber_weights
from fitter.pose_init.limbs import TRUNCATION


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlantEvidence:
    """Limbs whose slants the detector estimated.

    Attributes
    ----------
    ends
        (s, 2) near and far end, as indices into the clicked landmarks.
    toward
        (3,) unit vector from the camera to the person, camera frame.
    reach_m, sigma_m
        (s,) how much farther along that vector the far end lies than the near one, and its
        standard deviation, metres.
    """

    ends: Integer[np.ndarray, "s 2"]
    toward: Vector3
    reach_m: Float[np.ndarray, " s"]
    sigma_m: Float[np.ndarray, " s"]


def slant_energy(landmarks: Points3D, evidence: SlantEvidence) -> float:
    """Huber loss of each limb's reach, nats; landmarks (k, 3) in the camera frame."""
    distance = np.abs(_excess(landmarks, evidence)) / evidence.sigma_m
    return float(huber(distance, TRUNCATION).sum())


def slant_rows(landmarks: Points3D, evidence: SlantEvidence) -> PositionRows:
    """One row per limb; points index the landmark rows."""
    excess = _excess(landmarks, evidence)
    weights = huber_weights(np.abs(excess) / evidence.sigma_m, TRUNCATION)
    along = np.stack([-evidence.toward, evidence.toward])
    return PositionRows(
        residuals=excess,
        weights=weights / evidence.sigma_m**2,
        points=evidence.ends,
        derivatives=np.tile(along, (len(excess), 1, 1)),
        support=Support.LANDMARKS,
    )


def _excess(landmarks: Points3D, evidence: SlantEvidence) -> Float[np.ndarray, " s"]:
    """Excess of each limb's reach over the detector's estimate, metres."""
    limbs = landmarks[evidence.ends[:, 1]] - landmarks[evidence.ends[:, 0]]
    return limbs @ evidence.toward - evidence.reach_m
