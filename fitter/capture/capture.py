"""A picture that was taken, with what is known of the person in it."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import Mask
from fitter.detection.detector import DetectedBody
from fitter.request import Click
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.outcomes import WornRegion
from fitter.vocabulary.remarks import Box

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


MASK_LEVEL = 0.5
"""Probability from which a pixel belongs to the person."""

LIMB_BREADTH = 0.05
"""Breadth of what is taken for the person along the bones where there is no mask, of the stature:
about that of an arm."""

_BONES = (
    ("left_shoulder", "right_shoulder"), ("left_hip", "right_hip"),
    ("left_shoulder", "left_hip"), ("right_shoulder", "right_hip"),
    ("left_shoulder", "right_hip"), ("right_shoulder", "left_hip"),
    ("left_hip", "left_knee"), ("left_knee", "left_ankle"),
    ("right_hip", "right_knee"), ("right_knee", "right_ankle"),
    ("left_shoulder", "left_elbow"), ("right_shoulder", "right_elbow"),
)  # fmt: skip


@dataclass(frozen=True, eq=False, kw_only=True)
class Capture:
    """A picture and what is known of it; places are in pixels of the working picture (h, w).

    Attributes
    ----------
    picture
        (h, w, 3) sRGB, 8 bits.
    width, height
        Of the upright original.
    scale
        Working pixels per original pixel, at most 1.
    bodies
        Everybody a detector found; None where there was no detector.
    body
        The one of them who is meant; None if nobody was found, or nobody where the points are.
    points
        The caller's, by name; empty if there are none.
    is_chosen
        Whether the caller says who is meant, by points or otherwise.
    is_clicked
        Whether somebody put all points: none is a proposal, not even one that was sent back.
    view
        From where the person is said to be seen; None if nothing is said.
    focal_length_px
        Of the working picture; None if it could only be assumed.
    height_m
        Given or assumed.
    clothing
        How each region in sight is covered; None where it cannot be told.
    over_top
        Probability that something is worn over a top; None where that is not asked or not known.
    directions
        How trunk and limbs of a fitted body lie; None before a fit.
    """

    picture: UInt8[np.ndarray, "h w 3"]
    width: int
    height: int
    scale: float
    bodies: tuple[DetectedBody, ...] | None
    body: DetectedBody | None
    points: Mapping[str, Click]
    is_chosen: bool
    view: ViewKind | None
    focal_length_px: float | None
    height_m: float
    is_clicked: bool = False
    clothing: tuple[WornRegion, ...] | None = None
    over_top: float | None = None
    directions: Directions | None = None

    @property
    def shows_somebody(self) -> bool:
        """Whether there is anything to check but the picture as such."""
        is_pointed_at = self.bodies is None and bool(self.points)
        return self.body is not None or self.directions is not None or is_pointed_at

    @cached_property
    def joints(self) -> Joints:
        """Points that are looked at: the detector's own, else the caller's."""
        return joints_of(self.points if self.body is None else self.body.points)

    @cached_property
    def mask(self) -> Mask | None:
        """(h, w) the person as the detector cuts them out."""
        return None if self.body is None else self.body.mask >= MASK_LEVEL

    @cached_property
    def region(self) -> Mask:
        """(h, w) the person: their mask, else what lies along the bones, else the whole picture."""
        if self.mask is not None and self.mask.any():
            return self.mask
        drawn = np.zeros(self.picture.shape[:2], np.uint8)
        breadth = max(1, round(LIMB_BREADTH * (self.stature_px or 0.5 * max(drawn.shape))))
        for start, end in _BONES:
            if start in self.joints and end in self.joints:
                cv2.line(drawn, _whole(self.joints[start]), _whole(self.joints[end]), 1, breadth)
        return drawn > 0 if drawn.any() else np.ones(drawn.shape, bool)

    @cached_property
    def stature_px(self) -> float | None:
        """Height in the picture of the person, were they to stand straight; None if not known."""
        return stature_px(self.joints, self.body)

    def middle(self, pair: str) -> Float[np.ndarray, "2"] | None:
        """The middle of a left and a right point; None if one is missing."""
        return middle(self.joints, pair)

    def in_original(self, box: Box) -> Box:
        """A box of the working picture in pixels of the original."""
        left, top, right, bottom = (each / self.scale for each in box)
        return left, top, right, bottom


def box_of(body: DetectedBody) -> Box:
    """The bounding box of a mask, or of the points if the mask is empty; of the same picture."""
    rows = np.flatnonzero((body.mask >= MASK_LEVEL).any(axis=1))
    columns = np.flatnonzero((body.mask >= MASK_LEVEL).any(axis=0))
    if len(rows):
        return float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1)
    across = [click.x for click in body.points.values()] or [float(body.person.middle[0])]
    down = [click.y for click in body.points.values()] or [float(body.person.middle[1])]
    return min(across), min(down), max(across), max(down)


def _whole(place: Float[np.ndarray, "2"]) -> tuple[int, int]:
    return int(place[0]), int(place[1])
