"""Clicked bones: lines that are certain to run inside the person."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.request import Click

BONES = (
    ("left_shoulder", "left_elbow"), ("left_elbow", "left_wrist"),
    ("right_shoulder", "right_elbow"), ("right_elbow", "right_wrist"),
    ("left_hip", "left_knee"), ("left_knee", "left_ankle"),
    ("right_hip", "right_knee"), ("right_knee", "right_ankle"),
    ("left_shoulder", "right_shoulder"), ("left_hip", "right_hip"),
    ("left_shoulder", "right_hip"), ("right_shoulder", "left_hip"),
    ("neck", "left_shoulder"), ("neck", "right_shoulder"), ("neck", "head_top"),
    ("left_eye", "right_eye"), ("left_eye", "nose"), ("right_eye", "nose"),
    ("left_eye", "left_ear"), ("right_eye", "right_ear"), ("left_ear", "right_ear"),
    ("left_ankle", "left_toe"), ("left_ankle", "left_heel"), ("left_heel", "left_toe"),
    ("right_ankle", "right_toe"), ("right_ankle", "right_heel"), ("right_heel", "right_toe"),
)  # fmt: skip
"""Straight lines between clicks that stay inside the body in any pose. The line from the nose to
the neck does not: in profile it runs outside the chin. Nor does the one from a shoulder to the hip
below it: on slim people a third to a half of that line runs outside the waist, by up to 10 pixels,
and gives the gap between arm and trunk to the person. On seven rendered people it cost 8 cm of
waist on average; the trunk's diagonals mark the trunk well enough."""


def clicked_bones(clicks: Mapping[str, Click]) -> Float[np.ndarray, "b 2 2"]:
    """Both ends of every bone whose two points are clicked and not occluded, in pixels.

    What hides a point may not be part of the person, so occluded points mark nothing.
    """
    seen = {name: (click.x, click.y) for name, click in clicks.items() if not click.occluded}
    ends = [(seen[start], seen[end]) for start, end in BONES if start in seen and end in seen]
    return np.array(ends, dtype=np.float64).reshape(-1, 2, 2)


FOOT_SHARE = 0.8
"""How far toward the model's toes a foot is trusted: feet differ in length and direction."""


def foot_bones(
    clicks: Mapping[str, Click], body_points: Mapping[str, Float[np.ndarray, "2"]]
) -> Float[np.ndarray, "b 2 2"]:
    """Bones of feet that were clicked only at the ankle.

    People seldom click toes, and a foot may stand on ground of any colour: without a bone in each
    foot GrabCut gave both feet of a figure on brown earth to the ground, and the legs shrank.

    Parameters
    ----------
    clicks
        In working pixels.
    body_points
        Projected landmarks of the body found so far; the foot's direction is taken from them and
        applied at the clicked ankle.
    """
    ends: list[tuple[Float[np.ndarray, 2], Float[np.ndarray, 2]]] = []
    for side in ("left", "right"):
        ankle = clicks.get(f"{side}_ankle")
        if ankle is None or ankle.occluded or f"{side}_toe" in clicks:
            continue
        start = np.array([ankle.x, ankle.y])
        foot = body_points[f"{side}_toe"] - body_points[f"{side}_ankle"]
        ends.append((start, start + FOOT_SHARE * foot))
    return np.array(ends, dtype=np.float64).reshape(-1, 2, 2)
