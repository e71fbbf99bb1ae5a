"""Energies of landmarks: clicked points in the image, and slants of limbs along the view.

A picture shows a limb foreshortened, and tells neither how much of that is due to the limb's own
length nor whether it leans toward the camera or away; a network that has seen many people does.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points2D, Points3D, Vector3
from fitter.body.model import SparseRows
from fitter.energies.rows import PositionRows, Support, huber, huber_weights
from fitter.energies.scales import EnergyScales
from fitter.observation.clicks import BODY_CLICK_SPREAD_M
from fitter.pose_init import limbs
from fitter.render.camera import Camera
from fitter.request import Click


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClickEvidence:
    """Clicked points and the landmark rows they correspond to.

    Attributes
    ----------
    landmarks
        k rows over the vertices, in the order of the clicks.
    clicks
        (k, 2) working pixels.
    confidence
        (k,) 1 for a visible point, less for a guess at one that is hidden.
    spread_m
        (k,) standard deviation about the landmarks, apart from that of an unsteady hand, metres.
    """

    landmarks: SparseRows
    clicks: Points2D
    confidence: Float[np.ndarray, " k"]
    spread_m: Float[np.ndarray, " k"]

    def sigma(self, scales: EnergyScales) -> Float[np.ndarray, " k"]:
        """Standard deviation of each click in each direction, pixels."""
        return np.hypot(scales.click_hand, self.spread_m * scales.pixels_per_metre)


# Hidden points are guesses, and hair hides where the head ends.
_OCCLUDED_CONFIDENCE = 1.0 / 9.0
_HEAD_TOP_CONFIDENCE = 0.25

TRUNCATION = 2.0
"""Number of standard deviations beyond which a click is trusted less and less."""


def click_evidence(landmarks: SparseRows, clicks: Mapping[str, Click]) -> ClickEvidence:
    """Pair clicks (working pixels) with the model's landmark rows by name."""
    order = [landmarks.names.index(name) for name in clicks]
    spans = [slice(landmarks.pointers[i], landmarks.pointers[i + 1]) for i in order]
    confidence = [
        # The spread of a proposed point already allows for its being hidden.
        (_OCCLUDED_CONFIDENCE if click.occluded and click.spread_m is None else 1.0)
        * (_HEAD_TOP_CONFIDENCE if name == "head_top" else 1.0)
        for name, click in clicks.items()
    ]
    return ClickEvidence(
        landmarks=SparseRows(
            names=tuple(clicks),
            pointers=np.concatenate([[0], np.cumsum([s.stop - s.start for s in spans])]),
            indices=np.concatenate([landmarks.indices[s] for s in spans]),
            weights=np.concatenate([landmarks.weights[s] for s in spans]),
        ),
        clicks=np.array([[click.x, click.y] for click in clicks.values()], dtype=np.float64),
        confidence=np.array(confidence),
        spread_m=np.array(
            [
                BODY_CLICK_SPREAD_M if each.spread_m is None else each.spread_m
                for each in clicks.values()
            ]
        ),
    )


def click_energy(
    landmarks: Points3D, evidence: ClickEvidence, camera: Camera, scales: EnergyScales
) -> float:
    """Huber loss of each click's distance, in nats; landmarks (k, 3) in the camera frame."""
    distance = np.linalg.norm(camera.project(landmarks) - evidence.clicks, axis=1)
    loss = huber(distance / evidence.sigma(scales), TRUNCATION)
    return float((evidence.confidence * loss).sum())


def click_rows(
    landmarks: Points3D, evidence: ClickEvidence, camera: Camera, scales: EnergyScales
) -> PositionRows:
    """Two rows per click, x and y; points index the landmark rows."""
    offset = camera.project(landmarks) - evidence.clicks
    sigma = evidence.sigma(scales)
    distance = np.linalg.norm(offset, axis=1) / sigma
    weight = evidence.confidence * huber_weights(distance, TRUNCATION) / sigma**2
    count = len(landmarks)
    derivatives = np.stack(
        [camera.pull_back(landmarks, np.tile(axis, (count, 1))) for axis in np.eye(2)], axis=1
    )
    return PositionRows(
        residuals=offset.reshape(-1),
        weights=np.repeat(weight, 2),
        points=np.repeat(np.arange(count), 2)[:, None],
        derivatives=derivatives.reshape(-1, 1, 3),
        support=Support.LANDMARKS,
    )


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
    return float(huber(distance, limbs.TRUNCATION).sum())


def slant_rows(landmarks: Points3D, evidence: SlantEvidence) -> PositionRows:
    """One row per limb; points index the landmark rows."""
    excess = _excess(landmarks, evidence)
    weights = huber_weights(np.abs(excess) / evidence.sigma_m, limbs.TRUNCATION)
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
