"""Captures to check, of a picture asked about or fitted: reduced just as a fit does it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fitter.arrays import Image, Points3D
from fitter.capture.capture import Capture, Directions
from fitter.detection.detector import DetectedBody, Detector, body_of_clicks
from fitter.detection.worn_parts import WornShares
from fitter.energies.objective import Candidate
from fitter.errors import InvalidInputError
from fitter.fits.clothing import FACE_CLICKS, LEAST_PIXELS_PER_METRE, clothing_seen
from fitter.fits.ease import worn_over
from fitter.fits.outline_search import PictureSearch
from fitter.observation.clicks import check_places, scaled_clicks
from fitter.observation.decoding import DecodedPicture
from fitter.observation.focal_length import focal_length
from fitter.observation.pixels import (
    bytes_of_display,
    display_working_picture,
    linear_working_picture,
    working_size,
)
from fitter.observation.subject import MEAN_HEIGHT_M
from fitter.request import Click
from fitter.segmentation.bones import PART_NAMES, bone_parts, part_joints
from fitter.segmentation.skin_colour import PersonRegions
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.outcomes import FocalLengthSource, WornRegion
from fitter.vocabulary.remarks import Note, Remark, assumed

ASSUMED_HEIGHT_M = 1.7
"""Assumed height of people whose gender is not known either."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureQuestion:
    """Everything that is said of the picture.

    Attributes
    ----------
    view
        From where the person is to be seen.
    person
        Index among those found; None takes the largest, or the one the points are of.
    points
        By name, pixels of the upright original; they need not be many.
    """

    view: ViewKind | None = None
    person: int | None = None
    points: Mapping[str, Click] = field(default_factory=dict[str, Click])
    gender: Gender | None = None
    height_m: float | None = None
    focal_length_px: float | None = None
    focal_length_35mm: float | None = None


def capture_of(
    picture: DecodedPicture, question: CaptureQuestion, *, detector: Detector | None
) -> Capture:
    """The capture of a decoded picture.

    Raises
    ------
    InvalidInputError
        ``person-unknown``, or as :func:`fitter.observation.focal_length.focal_length` and
        :func:`fitter.observation.clicks.check_places`.
    """
    height, width = picture.height, picture.width
    check_places(question.points, width=width, height=height)
    focal = focal_length(
        question, picture.exif, width=width, height=height, stored_width=picture.stored_width
    )
    size = working_size(width=width, height=height)
    linear_rgb = linear_working_picture(picture.pixels, size.from_reduced(picture.reduction))
    working = bytes_of_display(display_working_picture(linear_rgb))
    points = scaled_clicks(question.points, size.scale)
    bodies = None if detector is None else detector.bodies(working, question.view)
    known = focal.source is not FocalLengthSource.ASSUMED
    capture = Capture(
        picture=working,
        width=width,
        height=height,
        scale=size.scale,
        bodies=bodies,
        body=_meant(bodies or (), question.person, points),
        points=points,
        is_chosen=question.person is not None or bool(points),
        view=question.view,
        focal_length_px=focal.pixels * size.scale if known else None,
        height_m=_height_m(question),
    )
    if detector is None or capture.body is None or capture.stature_px is None:
        return capture
    worn = detector.worn(working, capture.body.person)
    return _with_clothing(capture, linear_rgb, worn, question.gender)


def capture_of_fit(
    picture: PictureSearch,
    height_m: float,
    body: Candidate,
    clothing: tuple[WornRegion, ...] | None,
) -> Capture:
    """The capture of a picture that was fitted, from what the fit has of it anyway.

    Parameters
    ----------
    body
        As it was found in the picture.
    clothing
        How the fit saw the clothes; None where it could not.
    """
    observation, view = picture.observation, picture.view
    points = scaled_clicks(view.clicks, observation.scale)
    meant = _meant(observation.bodies or (), None, points)
    known = observation.focal_length_source is not FocalLengthSource.ASSUMED
    return Capture(
        picture=bytes_of_display(observation.display),
        width=observation.image_camera.width,
        height=observation.image_camera.height,
        scale=observation.scale,
        bodies=observation.bodies,
        body=meant,
        points=observation.clicks,
        is_chosen=bool(points),
        is_clicked=all(each.spread_m is None for each in observation.clicks.values()),
        view=view.kind,
        focal_length_px=observation.camera.focal_length_px if known else None,
        height_m=height_m,
        clothing=clothing,
        directions=directions_of(body.joints, picture.objective.operators.model.part_names),
    )


def directions_of(joints: Points3D, part_names: Sequence[str]) -> Directions:
    """Directions of trunk, thighs and shins, from joints (p, 3) in the camera frame, by part."""
    at = dict(zip(part_names, joints, strict=True))
    ends = {
        f"{side}_{limb}": (at[f"{side}_{limb}"], at[f"{side}_{following}"])
        for side in ("left", "right")
        for limb, following in (("thigh", "shin"), ("shin", "foot"))
    }
    ends["trunk"] = (
        at["left_thigh"] + at["right_thigh"],
        at["left_upper_arm"] + at["right_upper_arm"],
    )
    return {
        name: (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
        for name, (start, end) in ends.items()
    }


def _with_clothing(
    capture: Capture, linear_rgb: Image, worn: WornShares | None, gender: Gender | None
) -> Capture:
    """The same with the covering of each region, by parts that are told by the bones."""
    assert capture.mask is not None
    assert capture.stature_px is not None
    pixels_per_metre = capture.stature_px / capture.height_m
    step = max(int(pixels_per_metre / LEAST_PIXELS_PER_METRE), 1)
    person = np.ascontiguousarray(capture.mask[::step, ::step])
    points = {name: place / step for name, place in capture.joints.items()}
    face = [points[name] for name in FACE_CLICKS if _is_seen(capture, name)]
    regions = PersonRegions(
        person=person,
        parts=bone_parts(person, points, pixels_per_metre / step),
        part_names=PART_NAMES,
        face=np.mean(face, axis=0) if face else None,
        pixels_per_metre=pixels_per_metre / step,
    )
    if worn is not None:
        worn = WornShares(
            skin=np.ascontiguousarray(worn.skin[::step, ::step]),
            outer=np.ascontiguousarray(worn.outer[::step, ::step]),
        )
    clothing = clothing_seen(
        np.ascontiguousarray(linear_rgb[::step, ::step]),
        worn,
        regions,
        part_joints(points),
        gender=None if gender is None else gender.value,
    )
    over = None if clothing is None else worn_over(worn, regions)
    over_top = None if over is None else float(over.max())
    return replace(capture, clothing=clothing, over_top=over_top)


def _is_seen(capture: Capture, name: str) -> bool:
    points = capture.points if capture.body is None else capture.body.points
    return name in points and not points[name].occluded


def _meant(
    bodies: Sequence[DetectedBody], person: int | None, points: Mapping[str, Click]
) -> DetectedBody | None:
    if points and person is None:
        return body_of_clicks(bodies, points)
    chosen = _chosen_person(len(bodies), person)
    return None if chosen is None else bodies[chosen]


def _chosen_person(count: int, person: int | None) -> int | None:
    """Index of the one who is meant of so many; None of nobody."""
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


def _height_m(question: CaptureQuestion) -> float:
    if question.height_m is not None:
        return question.height_m
    return ASSUMED_HEIGHT_M if question.gender is None else MEAN_HEIGHT_M[question.gender]


def assumed_height(question: CaptureQuestion, height_m: float) -> tuple[Remark, ...]:
    """The height that was taken where none is said."""
    if question.height_m is not None:
        return ()
    whose = "people" if question.gender is None else f"the gender ({question.gender.value})"
    return (
        assumed(
            Note.HEIGHT_ASSUMED,
            f"No height was given; {height_m:.2f} m, about the mean of {whose}, was taken.",
            where=("height_m",),
        ),
    )
