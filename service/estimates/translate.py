"""Pure translations between the wire types of estimates and the fitter's, both ways."""

import io
from collections.abc import Collection, Sequence
from typing import cast

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from api_schemas import questions as wire
from api_schemas.points import Point, PointSource
from fitter.body.model import BodyModel
from fitter.fits.capture_check import CaptureQuestion
from fitter.fits.initial_body import InitialBody
from fitter.fits.proposal import Proposal, ProposedPoint
from fitter.population.body_estimate import BodyEstimate
from fitter.request import View
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE, STATURE
from fitter.vocabulary.points import PointName
from service.compute.fit_results import (
    assumption_results,
    body_result,
    camera_result,
    finding_results,
    measurement_results,
    rounded_parameters,
    warning_results,
)
from service.compute.translate import SEEN, clicks

JPEG_QUALITY = 90
"""Nothing is measured in these pictures; they are for the eye."""


def subject_view(subject: wire.InitialPoseRequest) -> View:
    """Translate what is said of a picture that is not there; its points are named."""
    return View(
        image=b"",
        clicks=clicks(subject.points),
        focal_length_px=subject.focal_length_px,
        focal_length_35mm=subject.focal_length_35mm,
        limb_facing={limb.value: facing for limb, facing in subject.limb_facing.items()},
    )


def initial_pose(
    initial: InitialBody, gender: Gender, part_names: Sequence[str]
) -> wire.InitialPose:
    """Translate an initial body."""
    return wire.InitialPose(
        gender=gender,
        height_m=initial.height_m,
        camera=camera_result(initial.camera),
        focal_length_source=initial.focal_length_source,
        body=body_result(initial.body, part_names),
        outline=tuple(tuple(_pixel(corner) for corner in loop) for loop in initial.outline),
        points={name: _pixel(place) for name, place in initial.landmarks.items()},
        residual_px={name: float(value) for name, value in initial.residual_px.items()},
        limbs=initial.limbs,
        assumptions=assumption_results(initial.assumptions),
        warnings=warning_results(initial.warnings),
    )


def capture_question(asked: wire.PointsRequest) -> CaptureQuestion:
    """Translate what is said of a picture; points are named."""
    return CaptureQuestion(
        view=asked.view,
        person=asked.person,
        points=clicks(asked.points),
        gender=asked.gender,
        height_m=asked.height_m,
        focal_length_px=asked.focal_length_px,
        focal_length_35mm=asked.focal_length_35mm,
    )


def points_proposal(found: Proposal) -> wire.PointsProposal:
    """Translate a proposal; the caller adds its mask."""
    points = {cast("PointName", name): _point(point) for name, point in found.points.items()}
    checked = found.checked
    return wire.PointsProposal(
        image_size=wire.ImageSize(width=found.width, height=found.height),
        persons=found.persons,
        person=found.person,
        points=points,
        doubtful=tuple(name for name, point in points.items() if point.visibility < SEEN),
        usable=checked.usable,
        findings=finding_results(checked.findings),
        not_checked=tuple(
            wire.NotChecked(code=each.code.value, reason=each.reason) for each in checked.unchecked
        ),
        seen_from=checked.seen,
        lean_deg=None if checked.lean_deg is None else round(checked.lean_deg, 1),
        distance_m=None if checked.distance_m is None else round(checked.distance_m, 2),
        assumptions=assumption_results(found.assumptions),
        warnings=warning_results(found.warnings),
    )


def grey_png(values: UInt8[np.ndarray, "h w"]) -> bytes:
    """Encode a grey picture, for speed rather than size."""
    encoded = io.BytesIO()
    Image.fromarray(values).save(encoded, "PNG", compress_level=1)
    return encoded.getvalue()


def jpeg(pixels: UInt8[np.ndarray, "h w 3"]) -> bytes:
    """Encode a picture to be looked at."""
    encoded = io.BytesIO()
    Image.fromarray(pixels).save(encoded, "JPEG", quality=JPEG_QUALITY)
    return encoded.getvalue()


def body_estimate(
    estimate: BodyEstimate, model: BodyModel, given: Collection[str]
) -> wire.BodyEstimate:
    """Translate an estimated body, of which the measurements of these names were given."""
    measurements = measurement_results(estimate.measurements, given)
    stature_cm = next(each.value for each in measurements if each.name == STATURE)
    return wire.BodyEstimate(
        gender=Gender(model.gender),
        height_m=round(stature_cm / CENTIMETRES_PER_METRE, 4),
        shape=rounded_parameters(estimate.shape),
        measurements=measurements,
        plausibility=round(estimate.plausibility, 4),
        body_model=str(model.header.get("checksum", "")),
        warnings=warning_results(estimate.warnings),
    )


def _point(point: ProposedPoint) -> Point:
    x, y = _pixel(np.array([point.click.x, point.click.y]))
    return Point(
        x=x,
        y=y,
        visibility=1 if point.click.occluded else SEEN,
        source=PointSource.PROPOSAL,
        confidence=round(point.visibility, 3),
    )


def _pixel(place: Float[np.ndarray, "2"]) -> tuple[float, float]:
    """Rounded to a hundredth: an outline has hundreds of corners, drawn on whole pixels."""
    return round(float(place[0]), 2), round(float(place[1]), 2)
