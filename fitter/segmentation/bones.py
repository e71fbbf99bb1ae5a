"""The part of the body that each pixel of a person shows, by the nearest bone.

A part is taken to be as thick as it usually is: a pixel belongs to the part to whose bone its
distance, less that thickness, is the least (an additively weighted Voronoi diagram).
"""

from collections.abc import Mapping
from typing import Final

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Mask, Points2D
from fitter.request import Click

Place = Float[np.ndarray, "2"]

THICKNESS_M: Final[Mapping[str, float]] = {
    "pelvis": 0.13, "spine": 0.12, "chest": 0.12, "neck": 0.05, "head": 0.09, "upper_arm": 0.045,
    "forearm": 0.035, "hand": 0.035, "thigh": 0.075, "shin": 0.045, "foot": 0.035,
}  # fmt: skip
"""Half the breadth of a part, by its name without the side."""

_MIDDLE: Final = ("pelvis", "spine", "chest", "neck", "head")

PART_NAMES: Final = _MIDDLE + tuple(
    f"{side}_{part}" for side in ("left", "right") for part in THICKNESS_M if part not in _MIDDLE
)
"""As the body model names its parts."""

WAIST_ALONG, CHEST_ALONG = 0.2, 0.58
"""Shares of the way from the hips to the shoulders at which pelvis ends and chest begins."""

BEYOND_JOINT: Final = 0.35
"""A hand beyond the wrist, of the forearm's length; below the hips the pelvis, of the trunk's, half
as much."""

_JOINTS: Final[Mapping[str, str]] = {
    "upper_arm": "shoulder", "forearm": "elbow", "hand": "wrist",
    "thigh": "hip", "shin": "knee", "foot": "ankle",
}  # fmt: skip
"""Joints at which parts begin, by the points' names."""


def part_joints(points: Mapping[str, Place]) -> dict[str, Place]:
    """First joints of the limbs' parts by name, as far as their points are known."""
    return {
        f"{side}_{part}": points[f"{side}_{joint}"]
        for part, joint in _JOINTS.items()
        for side in ("left", "right")
        if f"{side}_{joint}" in points
    }


def bone_parts(
    person: Mask, points: Mapping[str, Place], pixels_per_metre: float
) -> Integer[np.ndarray, "h w"]:
    """Index into :data:`PART_NAMES` of the part that each pixel shows, -1 off the person.

    Parameters
    ----------
    person
        (h, w) the person.
    points
        By the points' names, continuous pixels; parts whose bone has an unknown end are left out.
    """
    parts = np.full(person.shape, -1)
    rows, columns = np.nonzero(person)
    places = np.stack([columns + 0.5, rows + 0.5], axis=1)
    bones = _bones(points)
    if not len(places) or not bones:
        return parts
    away = np.stack(
        [
            _distances(places, start, end) - pixels_per_metre * THICKNESS_M[_kind(name)]
            for name, start, end in bones
        ]
    )
    numbers = np.array([PART_NAMES.index(name) for name, _, _ in bones])
    parts[rows, columns] = numbers[away.argmin(axis=0)]
    return parts


def _bones(points: Mapping[str, Place]) -> list[tuple[str, Place, Place]]:
    """Parts' names with both ends of their bones; the chest has a second one across."""
    found: list[tuple[str, Place, Place]] = []
    for side in ("left", "right"):
        chain = [points.get(f"{side}_{joint}") for joint in ("shoulder", "elbow", "wrist")]
        leg = [points.get(f"{side}_{joint}") for joint in ("hip", "knee", "ankle", "toe")]
        ends = [
            ("upper_arm", chain[0], chain[1]),
            ("forearm", chain[1], chain[2]),
            ("thigh", leg[0], leg[1]),
            ("shin", leg[1], leg[2]),
            ("foot", leg[2], leg[3]),
        ]
        if chain[1] is not None and chain[2] is not None:
            ends.append(("hand", chain[2], chain[2] + BEYOND_JOINT * (chain[2] - chain[1])))
        found += [
            (f"{side}_{part}", start, end)
            for part, start, end in ends
            if start is not None and end is not None
        ]
    return found + _trunk(points)


def _trunk(points: Mapping[str, Place]) -> list[tuple[str, Place, Place]]:
    if any(
        f"{side}_{joint}" not in points
        for side in ("left", "right")
        for joint in ("shoulder", "hip")
    ):
        return []
    left, right = points["left_shoulder"], points["right_shoulder"]
    shoulders = 0.5 * (left + right)
    hips = 0.5 * (points["left_hip"] + points["right_hip"])
    up = shoulders - hips
    waist, chest = hips + WAIST_ALONG * up, hips + CHEST_ALONG * up
    found = [
        ("pelvis", hips - 0.5 * BEYOND_JOINT * up, waist),
        ("spine", waist, chest),
        ("chest", chest, shoulders),
    ]
    face = [points[name] for name in ("nose", "left_ear", "right_ear") if name in points]
    if face:
        middle = np.mean(face, axis=0)
        found += [
            ("neck", shoulders, 0.5 * (shoulders + middle)),
            ("head", 0.7 * middle + 0.3 * shoulders, middle + 0.5 * (middle - shoulders)),
        ]
    return found


def _distances(places: Points2D, start: Place, end: Place) -> Float[np.ndarray, " s"]:
    """From a bone, pixels."""
    bone = end - start
    along = np.clip((places - start) @ bone / max(float(bone @ bone), 1e-9), 0.0, 1.0)
    return np.linalg.norm(places - start - along[:, None] * bone, axis=1)


def _kind(part: str) -> str:
    return part.removeprefix("left_").removeprefix("right_")


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
"""Trusted share of the model's foot, from the ankle: feet differ in length and direction."""


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
