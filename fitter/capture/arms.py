"""Whether the arms stand off the trunk, so that its outline is seen."""

import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import Mask
from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark, Unchecked
from fitter.capture.turning import is_broadside
from fitter.vocabulary.outcomes import Severity

LEAST_FREE = 0.3
"""Share of an arm below which it counts as lying against the trunk."""

LEAST_GAP = 0.01
"""Gap that can be seen, of the trunk's length: half a centimetre."""

_SIDES = {"left": "right", "right": "left"}
_UPPER_ARM, _FOREARM = np.linspace(0.5, 1.0, 6), np.linspace(0.1, 0.9, 8)
"""Where along the bones the gap is looked for: below the armpit, and up to the wrist."""


def arms(capture: Capture) -> Remark | None:
    """Whether between trunk and arms, seen from the front or from behind, background shows."""
    if capture.mask is None:
        return Unchecked(
            code=Code.ARMS_AGAINST_TRUNK, reason="Without a detector there is no outline."
        )
    if not is_broadside(capture):
        return Unchecked(
            code=Code.ARMS_AGAINST_TRUNK,
            reason="Only from the front or from behind are arms seen beside the trunk.",
        )
    shares = {side: free_share(capture, capture.mask, side) for side in _SIDES}
    against = {
        side: share for side, share in shares.items() if share is not None and share < LEAST_FREE
    }
    if not against:
        return None
    said = " and ".join(f"{100.0 * share:.0f} % of the {side}" for side, share in against.items())
    return Finding(
        code=Code.ARMS_AGAINST_TRUNK,
        severity=Severity.HARMS,
        reason=(
            f"Background shows between trunk and arm along {said} arm, from the armpit to the "
            f"wrist, where {100.0 * LEAST_FREE:.0f} % is the least."
        ),
        remedy="Have the arms held away from the body, by a hand's breadth at the hips or more.",
        points=tuple(f"{side}_{joint}" for side in against for joint in ("elbow", "wrist")),
    )


def free_share(capture: Capture, mask: Mask, side: str) -> float | None:
    """Share of an arm that background separates from the trunk; None if a joint is missing."""
    names = [f"{side}_{joint}" for joint in ("shoulder", "elbow", "wrist")]
    shoulders, hips = capture.middle("shoulder"), capture.middle("hip")
    if shoulders is None or hips is None or any(name not in capture.joints for name in names):
        return None
    shoulder, elbow, wrist = (capture.joints[name] for name in names)
    length = float(np.linalg.norm(hips - shoulders))
    if length == 0.0:
        return None
    along = (hips - shoulders) / length
    places = [shoulder + share * (elbow - shoulder) for share in _UPPER_ARM]
    places += [elbow + share * (wrist - elbow) for share in _FOREARM]
    gaps = [
        _gap(mask, place, shoulders + along * np.clip((place - shoulders) @ along, 0.0, length))
        for place in places
    ]
    return float(np.mean([gap >= LEAST_GAP * length for gap in gaps]))


def _gap(mask: Mask, start: Float[np.ndarray, "2"], end: Float[np.ndarray, "2"]) -> float:
    """Length of the background between two places, pixels."""
    distance = float(np.linalg.norm(end - start))
    steps = 2 * int(distance) + 2
    places = start + np.linspace(0.0, 1.0, steps)[:, None] * (end - start)
    columns = np.clip(places[:, 0].astype(int), 0, mask.shape[1] - 1)
    rows = np.clip(places[:, 1].astype(int), 0, mask.shape[0] - 1)
    background: Bool[np.ndarray, " s"] = ~mask[rows, columns]
    return distance * float(background.mean())
