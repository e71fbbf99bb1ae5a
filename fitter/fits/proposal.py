"""What the detector proposes for a picture, before any fit is requested.

The picture is decoded and reduced just as in a fit, so that the points are those a fit would
propose to itself.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.capture.capture import box_of
from fitter.capture.finding import Box
from fitter.detection.detector import DetectedBody, Detector
from fitter.errors import InvalidInputError
from fitter.fits.proposal_warnings import proposal_warnings
from fitter.observation.clicks import scaled_clicks
from fitter.observation.colour import bytes_of_display
from fitter.observation.decoding import DecodedPicture, decode_picture
from fitter.observation.resampling import (
    WorkingSize,
    display_working_picture,
    linear_working_picture,
    working_size,
)
from fitter.remarks import FitWarning
from fitter.request import Click

CIRCLE_RADIUS_M = 0.95
"""Assumed radius of the circle around a person: 0.54 of 1.75 m. The person's height is not known
yet."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedPerson:
    """A person that was found: left, top, right and bottom of what is visible, and a score.

    Pixels of the upright original; ``score``, 0 to 1, is how certain the detector is.
    """

    box: Box
    score: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedPoint:
    """A proposed point.

    Attributes
    ----------
    click
        In pixels of the upright original, with its spread.
    visibility
        0 to 1, as the detector estimates it.
    expected_error_px
        Root mean square error in each direction, pixels of the original.
    """

    click: Click
    visibility: float
    expected_error_px: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Proposal:
    """Who is in a picture, and what is proposed for one of them.

    Attributes
    ----------
    width, height
        Size of the upright original, to whose pixels everything refers.
    persons
        Everybody found, the largest and most certain first.
    person
        Index of the one whose points these are; None if nobody was found.
    points
        By canonical name; points outside the picture are left out.
    mask
        (height, width) 8 bits, probability that a pixel shows the person; None unless asked for.
    """

    width: int
    height: int
    persons: tuple[ProposedPerson, ...]
    person: int | None
    points: Mapping[str, ProposedPoint]
    mask: UInt8[np.ndarray, "h w"] | None
    warnings: tuple[FitWarning, ...]


def propose(
    image: bytes, *, detector: Detector, max_pixels: int, person: int | None, with_mask: bool
) -> Proposal:
    """Decode a picture and propose the points of a person in it.

    Parameters
    ----------
    image
        The encoded picture.
    max_pixels
        Largest picture accepted, checked before decoding.
    person
        Index among those found; None takes the largest.
    with_mask
        Whether to return the person's mask too.

    Raises
    ------
    InvalidInputError
        As :func:`fitter.observation.decoding.decode_picture`, or ``person-unknown``.
    """
    picture = decode_picture(image, field="image", max_pixels=max_pixels)
    return proposal_of(picture, detector=detector, person=person, with_mask=with_mask)


def proposal_of(
    picture: DecodedPicture, *, detector: Detector, person: int | None, with_mask: bool
) -> Proposal:
    """As :func:`propose`, for a picture that is already decoded."""
    height, width = picture.pixels.shape[:2]
    size = working_size(width=width, height=height)
    working = display_working_picture(linear_working_picture(picture.pixels, size))
    bodies = detector.bodies(bytes_of_display(working))
    chosen = chosen_person(len(bodies), person)
    body = None if chosen is None else bodies[chosen]
    return Proposal(
        width=width,
        height=height,
        persons=tuple(
            ProposedPerson(box=_box(each, size.scale), score=each.person.score) for each in bodies
        ),
        person=chosen,
        points={} if body is None else _points(body, size.scale),
        mask=_mask(body, size, width=width, height=height)
        if with_mask and body is not None
        else None,
        warnings=picture.warnings
        + proposal_warnings(bodies, chosen, was_chosen=person is not None),
    )


def chosen_person(count: int, person: int | None) -> int | None:
    """Index of the one who is meant of so many; None of nobody.

    Raises
    ------
    InvalidInputError
        ``person-unknown``.
    """
    if count == 0:
        return None
    if person is not None and person >= count:
        raise InvalidInputError(
            code="person-unknown",
            field="person",
            reason=f"There is no person {person}: {count} were found, counted from 0.",
            remedy="Send the place of one of `persons`, or leave it out for the largest.",
        )
    return person or 0


def _points(body: DetectedBody, scale: float) -> dict[str, ProposedPoint]:
    pixels_per_metre = body.person.radius / CIRCLE_RADIUS_M / scale
    return {
        name: ProposedPoint(
            click=click,
            visibility=body.visibility[name],
            expected_error_px=pixels_per_metre * (click.spread_m or 0.0),
        )
        for name, click in scaled_clicks(body.points, 1.0 / scale).items()
    }


def _box(body: DetectedBody, scale: float) -> Box:
    left, top, right, bottom = (each / scale for each in box_of(body))
    return left, top, right, bottom


def _mask(
    body: DetectedBody, size: WorkingSize, *, width: int, height: int
) -> UInt8[np.ndarray, "h w"]:
    """The mask at the original's size; beyond the working picture, its border is repeated."""
    coded = np.rint(255.0 * np.clip(body.mask, 0.0, 1.0)).astype(np.uint8)
    if size.scale == 1.0:
        return coded
    shift = 0.5 * size.scale - 0.5
    between_centres = np.array([[size.scale, 0.0, shift], [0.0, size.scale, shift]])
    return cv2.warpAffine(
        coded,
        between_centres,
        (width, height),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )
