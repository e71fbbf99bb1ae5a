"""The answers to questions: the fitter between two translations."""

import io
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final, cast

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from api_schemas import questions as wire
from api_schemas.points import Point, PointSource
from api_schemas.problems import FieldProblem
from fitter.body.model import BodyModel
from fitter.detection.detector import Detector, installed_detector
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.export.formats import converted
from fitter.export.glb import Frame
from fitter.export.gltf import plain_glb
from fitter.fits.capture_check import CaptureQuestion
from fitter.fits.equipment import prepared_model
from fitter.fits.initial_body import InitialBody, initial_body
from fitter.fits.proposal import Proposal, ProposedPoint, propose
from fitter.observation.decoding import decode_picture
from fitter.population.body_estimate import BodyEstimate, estimate_body
from fitter.request import KnownMeasurement, View
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE, STATURE
from fitter.vocabulary.points import PointName
from service.compute.fit_results import (
    body_result,
    camera_result,
    measurement_results,
    rounded_parameters,
)
from service.compute.questions import (
    BODY,
    CONVERSION,
    FILE,
    INITIAL_POSE,
    JPEG,
    POINTS,
    QUESTION,
    BodyTask,
    ConversionTask,
    answered,
)
from service.compute.tasks import (
    ChildSetup,
    Observe,
    Parts,
    ProblemError,
    Task,
    UnusableInputError,
)
from service.compute.translate import SEEN, clicks, field_problem, known_measurements, person
from service.submissions.submission import no_detector

JPEG_QUALITY: Final = 90
"""Nothing is measured in these pictures; they are for the eye."""

_TOO_MUCH_MEMORY = FieldProblem(
    field="image",
    code="out-of-memory",
    reason="The picture needs more memory than one question may have.",
    remedy="Send a smaller version; two million pixels are plenty.",
)


def body(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    """Estimate a body from measurements, by a :class:`BodyTask`."""
    task = BodyTask.model_validate_json(parts[QUESTION])
    known = _known(task.request)
    fittable = prepared_model(task.request.gender, models=setup.models)
    with _told():
        estimate = estimate_body(fittable.population, known)
    model = fittable.operators.model
    answer = _body_estimate(estimate, model, known)
    if not task.with_glb:
        return answered(answer)
    given = {each.name: each.value for each in answer.measurements if each.given}
    glb = plain_glb(
        estimate.canonical_vertices,
        model,
        name="body",
        frame=Frame.STANDING,
        extras={"known": given, "height_m": answer.height_m},
    )
    return answered(answer, glb)


def initial_pose(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    """Pose the mean person to match clicks, which are named, by a wire request."""
    asked = wire.InitialPoseRequest.model_validate_json(parts[QUESTION])
    fittable = prepared_model(asked.gender, models=setup.models)
    view = View(
        image=b"",
        clicks=clicks(asked.points),
        focal_length_px=asked.focal_length_px,
        focal_length_35mm=asked.focal_length_35mm,
        limb_facing={limb.value: facing for limb, facing in asked.limb_facing.items()},
    )
    size = asked.image_size
    with _told():
        initial = initial_body(person(asked), view, fittable, width=size.width, height=size.height)
    return answered(_initial_pose(initial, asked.gender, fittable.operators.model.part_names))


def points(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    """Propose the points of a person in an encoded picture, and say what is wrong with it.

    The points that are known are named. Without a detector it says what they tell; if there are
    none, the question ends with a problem.
    """
    asked = wire.PointsRequest.model_validate_json(parts[QUESTION])
    question = CaptureQuestion(
        view=asked.view,
        person=asked.person,
        points=clicks(asked.points),
        gender=asked.gender,
        height_m=asked.height_m,
        focal_length_px=asked.focal_length_px,
        focal_length_35mm=asked.focal_length_35mm,
    )
    with _told():
        found = propose(
            parts[FILE],
            question,
            detector=_detector(setup.detector, needed=not question.points),
            max_pixels=setup.max_pixels,
            with_mask=asked.mask,
        )
    mask = b"" if found.mask is None else _encoded(found.mask, "PNG", compress_level=1)
    return answered(_points_proposal(found), mask)


def conversion(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    """Write the body of a GLB file in another format, by a :class:`ConversionTask`."""
    task = ConversionTask.model_validate_json(parts[QUESTION])
    return {FILE: converted(parts[FILE], task.ending)}


def jpeg(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    """Write an encoded picture as a JPEG, upright."""
    with _told():
        picture = decode_picture(parts[FILE], field="image", max_pixels=setup.max_pixels)
        return {FILE: _encoded(picture.pixels, "JPEG", quality=JPEG_QUALITY)}


@contextmanager
def _told() -> Iterator[None]:
    """Tell faults of the input as problems."""
    try:
        yield
    except MemoryError as error:
        raise UnusableInputError(_TOO_MUCH_MEMORY) from error
    except InvalidInputError as error:
        raise UnusableInputError(field_problem(error)) from error


def _encoded(pixels: UInt8[np.ndarray, "..."], kind: str, **options: int) -> bytes:
    encoded = io.BytesIO()
    Image.fromarray(pixels).save(encoded, kind, **options)
    return encoded.getvalue()


def _detector(folder: Path | None, *, needed: bool) -> Detector | None:
    try:
        return installed_detector(folder)
    except DetectorUnavailableError as error:
        if needed:
            raise ProblemError(no_detector()) from error
        return None


def _known(request: wire.BodyRequest) -> dict[str, KnownMeasurement]:
    known = known_measurements(request)
    if request.height_m is None:
        return known
    stature_cm = request.height_m * CENTIMETRES_PER_METRE
    return {STATURE: KnownMeasurement(value=stature_cm, field="height_m")} | known


def _initial_pose(
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
        assumptions=initial.assumptions,
        warnings=initial.warnings,
    )


def _points_proposal(found: Proposal) -> wire.PointsProposal:
    """Translate a proposal."""
    points: dict[PointName, Point] = {
        cast("PointName", name): _point(point) for name, point in found.points.items()
    }
    checked = found.checked
    return wire.PointsProposal(
        image_size=wire.ImageSize(width=found.width, height=found.height),
        persons=found.persons,
        person=found.person,
        points=points,
        doubtful=tuple(name for name, point in points.items() if point.visibility < SEEN),
        usable=checked.usable,
        findings=checked.findings,
        not_checked=checked.unchecked,
        seen_from=checked.seen,
        lean_deg=None if checked.lean_deg is None else round(checked.lean_deg, 1),
        distance_m=None if checked.distance_m is None else round(checked.distance_m, 2),
        clothing=found.clothing,
        assumptions=found.assumptions,
        warnings=found.warnings,
    )


def _body_estimate(
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
        warnings=estimate.warnings,
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


TASKS: Final[Mapping[str, Task]] = {
    BODY: body,
    INITIAL_POSE: initial_pose,
    POINTS: points,
    CONVERSION: conversion,
    JPEG: jpeg,
}
