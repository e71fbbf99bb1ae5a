"""Proposals for a picture, and its faults, before any fit is requested.

The picture is decoded and reduced just as in a fit, so that the points are those a fit would
propose to itself.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.capture.capture import Capture, box_of
from fitter.capture.checking import Checked, check_capture
from fitter.capture.clothes import clothing_guess
from fitter.detection.detector import DetectedBody, Detector
from fitter.fits.capture_check import CaptureQuestion, assumed_height, capture_of
from fitter.observation.clicks import scaled_clicks
from fitter.observation.decoding import decode_picture
from fitter.observation.subject import check_height
from fitter.request import Click
from fitter.vocabulary.outcomes import ClothingGuess
from fitter.vocabulary.remarks import Box, Note, Remark, remark


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedPoint:
    """A proposed point.

    Attributes
    ----------
    click
        In pixels of the upright original, with its spread.
    visibility
        0 to 1, as the detector estimates it.
    """

    click: Click
    visibility: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Proposal:
    """The people in a picture, a proposal for one of them, and the faults of the picture.

    Attributes
    ----------
    width, height
        Size of the upright original, to whose pixels everything refers.
    persons
        Boxes of what is visible of everybody found, pixels of the upright original; the largest
        and most certain first; nobody without a detector.
    person
        Index of the one whose points these are; None if nobody was found.
    points
        By canonical name; points outside the picture are left out.
    mask
        (height, width) 8 bits, probability that a pixel shows the person; None unless asked for.
    checked
        What the checks say, as of a fit of the picture.
    clothing
        How the clothes look; None where nobody was found.
    assumptions
        What the checks assumed.
    warnings
        Of decoding, and of what to look at in the points.
    """

    width: int
    height: int
    persons: tuple[Box, ...]
    person: int | None
    points: Mapping[str, ProposedPoint]
    mask: UInt8[np.ndarray, "h w"] | None
    checked: Checked
    clothing: ClothingGuess | None
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]


def propose(
    image: bytes,
    question: CaptureQuestion,
    *,
    detector: Detector | None,
    max_pixels: int,
    with_mask: bool = False,
) -> Proposal:
    """Decode a picture, propose the points of a person in it and make every check that can be made.

    Parameters
    ----------
    image
        The encoded picture.
    detector
        None where there is none: nothing is proposed, and what points and picture tell is checked.
    max_pixels
        Largest picture accepted, checked before decoding.
    with_mask
        Whether to return the person's mask too.

    Raises
    ------
    InvalidInputError
        ``out-of-range``, or as :func:`fitter.observation.decoding.decode_picture` and
        :func:`fitter.fits.capture_check.capture_of`.
    """
    check_height(question.height_m)
    picture = decode_picture(image, field="image", max_pixels=max_pixels)
    capture = capture_of(picture, question, detector=detector)
    bodies, body = capture.bodies or (), capture.body
    return Proposal(
        width=capture.width,
        height=capture.height,
        persons=tuple(_box(each, capture.scale) for each in bodies),
        person=next((place for place, each in enumerate(bodies) if each is body), None),
        points={} if body is None else _points(body, capture.scale),
        mask=_mask(body, capture) if with_mask and body is not None else None,
        checked=check_capture(capture),
        clothing=clothing_guess(capture),
        assumptions=assumed_height(question, capture.height_m),
        warnings=picture.warnings + (() if body is None else proposal_warnings(body.points)),
    )


def _points(body: DetectedBody, scale: float) -> dict[str, ProposedPoint]:
    return {
        name: ProposedPoint(click=click, visibility=body.visibility[name])
        for name, click in scaled_clicks(body.points, 1.0 / scale).items()
    }


def _box(body: DetectedBody, scale: float) -> Box:
    left, top, right, bottom = (each / scale for each in box_of(body))
    return left, top, right, bottom


def _mask(body: DetectedBody, capture: Capture) -> UInt8[np.ndarray, "h w"]:
    """The mask at the original's size; beyond the working picture, its border is repeated."""
    coded = np.rint(255.0 * np.clip(body.mask, 0.0, 1.0)).astype(np.uint8)
    if capture.scale == 1.0:
        return coded
    shift = 0.5 * capture.scale - 0.5
    between_centres = np.array([[capture.scale, 0.0, shift], [0.0, capture.scale, shift]])
    return cv2.warpAffine(
        coded,
        between_centres,
        (capture.width, capture.height),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )


FACE = ("nose", "left_eye", "right_eye")

Segment = tuple[Click, Click]

CHAINS = {
    "arms": ("shoulder", "elbow", "wrist"),
    "legs": ("hip", "knee", "ankle"),
}
"""Joints of arms and legs, from the trunk outward."""


def proposal_warnings(points: Mapping[str, Click]) -> tuple[Remark, ...]:
    """Warnings of proposed points; everything is in pixels of the working picture."""
    found = {
        Note.SEEN_FROM_BEHIND: (
            _is_from_behind(points),
            "The person seems to be seen from behind.",
        ),
        Note.LIMBS_CROSSED: (
            any(_are_crossed(points, chain) for chain in CHAINS.values()),
            "Arms or legs cross in the picture.",
        ),
    }
    return tuple(remark(code, reason) for code, (holds, reason) in found.items() if holds)


def _is_from_behind(points: Mapping[str, Click]) -> bool:
    left, right = points.get("left_shoulder"), points.get("right_shoulder")
    if left is None or right is None or left.x >= right.x:
        return False
    return all(name not in points or points[name].occluded for name in FACE)


def _are_crossed(points: Mapping[str, Click], chain: Sequence[str]) -> bool:
    """Whether a part of the left limb crosses one of the right limb."""
    return any(
        _cross(one, other)
        for one in _segments(points, "left", chain)
        for other in _segments(points, "right", chain)
    )


def _segments(points: Mapping[str, Click], side: str, chain: Sequence[str]) -> Iterator[Segment]:
    """The parts of a limb whose two ends are both known."""
    for near, far in pairwise(points.get(f"{side}_{joint}") for joint in chain):
        if near is not None and far is not None:
            yield near, far


def _cross(one: Segment, other: Segment) -> bool:
    """Whether two segments have an inner point in common."""
    return (
        _turn(*one, other[0]) * _turn(*one, other[1]) < 0.0
        and _turn(*other, one[0]) * _turn(*other, one[1]) < 0.0
    )


def _turn(start: Click, end: Click, point: Click) -> float:
    """Twice the signed area of a triangle.

    Positive where ``point`` lies to the right of the way from start to end, as seen in the picture.
    """
    return (end.x - start.x) * (point.y - start.y) - (end.y - start.y) * (point.x - start.x)
