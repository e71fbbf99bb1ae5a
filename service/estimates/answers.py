"""The real answers: the fitter between two translations."""

from pathlib import Path

from api_schemas.problems import FieldProblem
from api_schemas.questions import BodyRequest, InitialPose, InitialPoseRequest, PointsRequest
from fitter.detection.detector import Detector, installed_detector
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.export.formats import converted
from fitter.export.glb import Frame
from fitter.export.gltf import plain_glb
from fitter.fits.equipment import prepared_model
from fitter.fits.initial_body import initial_body
from fitter.fits.proposal import propose
from fitter.observation.decoding import decode_picture
from fitter.population.body_estimate import estimate_body
from fitter.request import KnownMeasurement
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE, STATURE
from service.compute.tasks import ProblemError, UnusableInputError
from service.compute.translate import field_problem, known_measurements, person
from service.estimates import translate
from service.estimates.questions import (
    BodyTask,
    ConversionTask,
    EstimatedBody,
    ProposedPoints,
    estimate_tasks,
)
from service.submissions.submission import no_detector

_TOO_MUCH_MEMORY = FieldProblem(
    field="image",
    code="out-of-memory",
    reason="The picture needs more memory than one question may have.",
    remedy="Send a smaller version; two million pixels are plenty.",
)


def body(task: BodyTask, models: Path | None) -> EstimatedBody:
    """Estimate a body from measurements."""
    gender = task.request.gender
    fittable = prepared_model(gender, models=models)
    known = _known(task.request)
    try:
        estimate = estimate_body(fittable.population, known)
    except InvalidInputError as error:
        raise UnusableInputError(field_problem(error)) from error
    model = fittable.operators.model
    answer = translate.body_estimate(estimate, model, known)
    glb = b""
    if task.with_glb:
        glb = plain_glb(
            estimate.canonical_vertices,
            model,
            name="body",
            frame=Frame.STANDING,
            extras={
                "known": {
                    measurement.name: measurement.value
                    for measurement in answer.measurements
                    if measurement.given
                },
                "height_m": answer.height_m,
            },
        )
    return EstimatedBody(estimate=answer, glb=glb)


def initial_pose(asked: InitialPoseRequest, models: Path | None) -> InitialPose:
    """Pose the mean person to match clicks, which are named."""
    fittable = prepared_model(asked.gender, models=models)
    try:
        initial = initial_body(
            person(asked),
            translate.subject_view(asked),
            fittable,
            width=asked.image_size.width,
            height=asked.image_size.height,
        )
    except InvalidInputError as error:
        raise UnusableInputError(field_problem(error)) from error
    return translate.initial_pose(initial, asked.gender, fittable.operators.model.part_names)


def points(
    asked: PointsRequest, image: bytes, *, max_pixels: int, detector: Path | None
) -> ProposedPoints:
    """Propose the points of a person in an encoded picture, and say what is wrong with it.

    The points that are known are named. Without a detector it says what they tell, if there are
    any.

    Raises
    ------
    UnusableInputError
        If the picture or what is asked of it is at fault.
    ProblemError
        If there is no detector, and there are no points.
    """
    question = translate.capture_question(asked)
    try:
        found = propose(
            image,
            question,
            detector=_detector(detector, needed=not question.points),
            max_pixels=max_pixels,
            with_mask=asked.mask,
        )
    except MemoryError as error:
        raise UnusableInputError(_TOO_MUCH_MEMORY) from error
    except InvalidInputError as error:
        raise UnusableInputError(field_problem(error)) from error
    mask = b"" if found.mask is None else translate.grey_png(found.mask)
    return ProposedPoints(proposal=translate.points_proposal(found), mask=mask)


def conversion(task: ConversionTask, glb: bytes) -> bytes:
    """Write the body of a GLB file in another format."""
    return converted(glb, task.ending)


def jpeg(image: bytes, *, max_pixels: int) -> bytes:
    """Write an encoded picture as a JPEG, upright."""
    try:
        picture = decode_picture(image, field="image", max_pixels=max_pixels)
        return translate.jpeg(picture.pixels)
    except MemoryError as error:
        raise UnusableInputError(_TOO_MUCH_MEMORY) from error
    except InvalidInputError as error:
        raise UnusableInputError(field_problem(error)) from error


def _detector(folder: Path | None, *, needed: bool) -> Detector | None:
    try:
        return installed_detector(folder)
    except DetectorUnavailableError as error:
        if needed:
            raise ProblemError(no_detector()) from error
        return None


def _known(request: BodyRequest) -> dict[str, KnownMeasurement]:
    known = known_measurements(request)
    if request.height_m is None:
        return known
    stature_cm = request.height_m * CENTIMETRES_PER_METRE
    return {STATURE: KnownMeasurement(value=stature_cm, field="height_m")} | known


TASKS = estimate_tasks(
    body=body,
    initial_pose=initial_pose,
    points=points,
    conversion=conversion,
    jpeg=jpeg,
)
