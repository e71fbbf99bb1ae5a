"""Click energy: clicked points against the model's own landmarks, in the image."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points2D, Points3D
from fitter.body.model import SparseRows
from fitter.camera import Camera
from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales
from fitter.numerics.robust import huber, huber_weights


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClickEvidence:
    """Clicked points and the landmark rows they stand for.

    Attributes
    ----------
    landmarks
        k rows over the vertices, in the order of the clicks.
    clicks
        (k, 2) working pixels.
    confidence
        (k,) 1 for a visible point, less for one guessed behind something.
    """

    landmarks: SparseRows
    clicks: Points2D
    confidence: Float[np.ndarray, " k"]


def click_energy(
    landmarks: Points3D, evidence: ClickEvidence, camera: Camera, scales: EnergyScales
) -> float:
    """Huber loss of each click's distance, in nats; landmarks (k, 3) in the camera frame."""
    distance = np.linalg.norm(camera.project(landmarks) - evidence.clicks, axis=1)
    loss = huber(distance, scales.click_truncation)
    return float((evidence.confidence * loss).sum()) / scales.click_sigma**2


def click_rows(
    landmarks: Points3D, evidence: ClickEvidence, camera: Camera, scales: EnergyScales
) -> PositionRows:
    """Two rows a click, x and y; points index the landmark rows."""
    offset = camera.project(landmarks) - evidence.clicks
    distance = np.linalg.norm(offset, axis=1)
    weight = evidence.confidence * huber_weights(distance, scales.click_truncation)
    count = len(landmarks)
    derivatives = np.stack(
        [camera.pull_back(landmarks, np.tile(axis, (count, 1))) for axis in np.eye(2)], axis=1
    )
    return PositionRows(
        residuals=offset.reshape(-1),
        weights=np.repeat(weight, 2) / scales.click_sigma**2,
        points=np.repeat(np.arange(count), 2)[:, None],
        derivatives=derivatives.reshape(-1, 1, 3),
    )
