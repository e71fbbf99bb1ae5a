"""Where a person's joints are in a picture, and how tall they make the person."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.detection.detector import DetectedBody
from fitter.request import Click

Joints = Mapping[str, Float[np.ndarray, "2"]]
"""Places by the points' names, continuous pixels."""

Directions = Mapping[str, Float[np.ndarray, "3"]]
"""Unit vectors in camera axes (x right, y down, z along the view): ``trunk`` from hips to
shoulders, ``left_thigh`` and so on from their near ends."""

RADIUS_OF_STATURE = 0.54
"""Radius of the circle around a person, as a share of their stature."""

CHAIN_OF_STATURE = 0.75
"""Shoulders to hips to knees to ankles, as a share of the stature: 0.71 to 0.79 on the tuning
pictures, of detected points and of clicks, from the front and from the side. The circle's radius
errs by a fifteenth, and by a third at worst."""


def joints_of(points: Mapping[str, Click]) -> Joints:
    """The places of points."""
    return {name: np.array([click.x, click.y], dtype=np.float64) for name, click in points.items()}


def middle(joints: Joints, pair: str) -> Float[np.ndarray, "2"] | None:
    """The middle of a left and a right point; None if one is missing."""
    left, right = joints.get(f"left_{pair}"), joints.get(f"right_{pair}")
    return None if left is None or right is None else 0.5 * (left + right)


def stature_px(joints: Joints, body: DetectedBody | None) -> float | None:
    """Height in the picture of the person, were they to stand straight; None if not known.

    By trunk and legs, else by the circle a detector puts around the person.
    """
    chain = _chain(joints)
    if chain is not None:
        return chain / CHAIN_OF_STATURE
    return None if body is None else body.person.radius / RADIUS_OF_STATURE


def _chain(joints: Joints) -> float | None:
    """From the shoulders by the hips and the leg that looks longer to its ankle, pixels."""
    shoulders, hips = middle(joints, "shoulder"), middle(joints, "hip")
    legs = [
        _length(joints, hip, knee) + _length(joints, knee, ankle)
        for side in ("left", "right")
        for hip, knee, ankle in [(f"{side}_hip", f"{side}_knee", f"{side}_ankle")]
        if {hip, knee, ankle} <= joints.keys()
    ]
    if shoulders is None or hips is None or not legs:
        return None
    chain = float(np.linalg.norm(hips - shoulders)) + max(legs)
    return chain if chain > 0.0 else None


def _length(joints: Joints, start: str, end: str) -> float:
    return float(np.linalg.norm(joints[end] - joints[start]))
