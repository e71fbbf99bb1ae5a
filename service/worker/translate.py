"""Pure translations between the wire types and the fitter's, both ways."""

import math
from collections.abc import Sequence
from typing import Any
from uuid import UUID

import numpy as np

from api_schemas import known as wire_known
from api_schemas import requests as wire_request
from api_schemas import results as wire
from api_schemas.derivation_kinds.combined import CombinedPicture
from api_schemas.points import Point, Points, PointSource, points_by_name
from api_schemas.problems import FieldProblem
from fitter.detection.landmark_meanings import INDEX_OF_POINT, UNSEEN_CONFIDENCE, spread_m
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.fits.progress import Progress
from fitter.measurement.quantity import Measurement
from fitter.parameters import (
    BodyParameters,
    CameraTilt,
    Light,
    LightKind,
    Reflectance,
    Surroundings,
)
from fitter.person.fitted_person import FittedPerson
from fitter.remarks import Assumption, FitWarning
from fitter.render.camera import Camera
from fitter.request import (
    Choices,
    Click,
    Clothing,
    Cues,
    Facing,
    FitRequest,
    Gender,
    KnownMeasurement,
    LightGuess,
    OptimizerKind,
    Person,
    SegmentationKind,
    SurroundingsKind,
    View,
    ViewKind,
)
from fitter.result import FitResult, FitStage, LimbFacing, PictureFit
from service.engine.port import Report
from service.submissions.detector import DETECTOR_MISSING

SEEN = 2


def fit_request(
    options: wire_request.FitOptions,
    *,
    image: bytes,
    mask: bytes | None,
    max_pixels: int,
) -> FitRequest:
    """Translate a request of one picture whose points are named."""
    return FitRequest(
        person=person(options),
        views=(view(options, image=image, mask=mask),),
        choices=choices(options, max_pixels=max_pixels),
    )


def person(options: wire_request.Person) -> Person:
    """Translate what is said of the person."""
    return Person(
        gender=Gender(options.gender),
        height_m=options.height_m,
        measurements=known_measurements(options),
    )


def choices(options: wire_request.FitOptions, *, max_pixels: int) -> Choices:
    """Translate what is to be done, whatever the pictures."""
    return Choices(
        optimizer=OptimizerKind(options.optimizer), force=options.force, max_pixels=max_pixels
    )


def view(
    options: wire_request.FitOptions,
    *,
    image: bytes,
    mask: bytes | None,
    kind: ViewKind | None = None,
) -> View:
    """Translate what is said of one picture."""
    return View(
        image=image,
        mask=mask,
        kind=kind,
        clicks=clicks(options.points),
        focal_length_px=options.focal_length_px,
        focal_length_35mm=options.focal_length_35mm,
        cues=Cues(options.cues),
        clothing=Clothing(options.clothing),
        complete_clicks=options.complete_points,
        segmentation=SegmentationKind(options.segmentation),
        slant_hints=options.slant_hints,
        light=LightGuess(
            kind=LightKind(options.light.kind),
            azimuth=_radians(options.light.azimuth_deg),
            elevation=_radians(options.light.elevation_deg),
            distance=options.light.distance_m,
            surroundings=SurroundingsKind(options.light.surroundings),
        ),
        limb_facing={limb.value: Facing(facing) for limb, facing in options.limb_facing.items()},
    )


def clicks(points: Points) -> dict[str, Click]:
    """Translate named points; proposed ones get the spread of proposals of that name."""
    return {name: _click(name, point) for name, point in points_by_name(points).items()}


def known_measurements(known: wire_known.KnownMeasurements) -> dict[str, KnownMeasurement]:
    """Translate what is known besides the height, by measurement name, each in its unit."""
    measurements = {
        name: KnownMeasurement(value=given.value, standard_error=given.standard_error)
        if isinstance(given, wire_known.UncertainMeasurement)
        else KnownMeasurement(value=given)
        for name, given in known.measurements.items()
    }
    if known.weight_kg is None:
        return measurements
    return {
        wire_known.WEIGHT: KnownMeasurement(value=known.weight_kg, field="weight_kg")
    } | measurements


def report(progress: Progress) -> Report:
    """Translate a progress report."""
    return Report(
        stage=progress.stage.value,
        progress=progress.fraction,
        view=progress.view,
        energies=dict(progress.energies),
    )


def field_problem(error: InvalidInputError) -> FieldProblem:
    """Translate the fitter's error about its input."""
    return FieldProblem(
        field=error.field,
        code=error.code,
        reason=error.reason,
        remedy=error.remedy,
        largest=error.largest,
    )


def detector_problem(error: DetectorUnavailableError) -> FieldProblem:
    """Say that points were to be proposed but there is no detector."""
    return FieldProblem(
        field="points", code=DETECTOR_MISSING, reason=error.reason, remedy=error.remedy
    )


def fit_result(result: FitResult, *, part_names: Sequence[str]) -> wire.FitResult:
    """Translate the result of one picture; its files are listed later, once they exist."""
    (view,) = result.views
    found, person = view.found, view.found.person
    return wire.FitResult(
        gender=wire_request.Gender(person.gender.value),
        height_m=found.height_m,
        cues=wire_request.Cues(found.cues.value),
        optimizer=wire_request.OptimizerKind(result.optimizer.value),
        outcome=wire.Outcome(found.outcome.value),
        verdict=wire.Verdict(found.verdict.value),
        outcome_explanation=found.outcome_explanation,
        camera=fitted_camera(view.camera, person.tilt),
        image_camera=fitted_camera(person.camera, person.tilt),
        focal_length_source=wire.FocalLengthSource(view.focal_length_source.value),
        body=body_result(person.body, part_names),
        stance=stance_result(person),
        light=None if person.light is None else _light(person.light),
        reflectance=None if person.reflectance is None else _reflectance(person.reflectance),
        energies=dict(result.energies),
        evaluations=result.evaluations,
        silhouette_overlap=found.silhouette_overlap,
        measurements=measurement_results(result.measurements, result.given),
        stages=tuple(_stage(stage, part_names, result.given) for stage in result.stages),
        limb_facing=tuple(_limb_facing(facing) for facing in view.limb_facing),
        assumptions=assumption_results(view.assumptions + result.assumptions),
        warnings=warning_results(view.warnings + result.warnings),
        stage_seconds=dict(result.stage_seconds),
        artifacts=(),
    )


def combined_picture(
    found: PictureFit, *, number: int, fit_id: UUID, part_names: Sequence[str]
) -> CombinedPicture:
    """Translate the person as fitted in one of several pictures."""
    return CombinedPicture(number=number, fit_id=fit_id, **in_picture(found, part_names))


def in_picture(found: PictureFit, part_names: Sequence[str]) -> dict[str, Any]:
    """The fields of a :class:`api_schemas.results.PictureResult`."""
    person = found.person
    return {
        "outcome": wire.Outcome(found.outcome.value),
        "image_camera": fitted_camera(person.camera, person.tilt),
        "body": body_result(person.body, part_names),
        "light": None if person.light is None else _light(person.light),
        "reflectance": None if person.reflectance is None else _reflectance(person.reflectance),
        "silhouette_overlap": found.silhouette_overlap,
    }


def stance_result(person: FittedPerson) -> wire.StanceResult | None:
    """Translate how the person stands, None where it was not estimated."""
    return None if person.tilt is None else _stance(person.tilt)


def assumption_results(assumptions: Sequence[Assumption]) -> tuple[wire.Assumption, ...]:
    """Translate what was assumed."""
    return tuple(
        wire.Assumption(quantity=each.quantity, value=each.value, reason=each.reason)
        for each in assumptions
    )


def warning_results(warnings: Sequence[FitWarning]) -> tuple[wire.FitWarning, ...]:
    """Translate warnings."""
    return tuple(wire.FitWarning(code=each.code, message=each.message) for each in warnings)


def _click(name: str, point: Point) -> Click:
    is_seen = point.visibility >= SEEN
    # The detector proposes no neck, so one that is sent as a proposal was clicked.
    is_proposal = point.source is PointSource.PROPOSAL and name in INDEX_OF_POINT
    confidence = point.confidence
    if confidence is None:
        confidence = 1.0 if is_seen else UNSEEN_CONFIDENCE
    return Click(
        x=point.x,
        y=point.y,
        occluded=not is_seen,
        spread_m=spread_m(name, confidence) if is_proposal else None,
    )


def _radians(degrees: float | None) -> float | None:
    return None if degrees is None else math.radians(degrees)


def camera_result(camera: Camera) -> wire.CameraResult:
    """Translate a camera."""
    return wire.CameraResult(
        focal_length_px=float(camera.focal_length_px),
        centre_x=float(camera.centre_x),
        centre_y=float(camera.centre_y),
        width=camera.width,
        height=camera.height,
    )


def fitted_camera(camera: Camera, tilt: CameraTilt | None) -> wire.FittedCameraResult:
    """Translate a camera with how it was held."""
    plain = camera_result(camera).model_dump()
    if tilt is None:
        return wire.FittedCameraResult(**plain)
    pitch_error, roll_error = tilt.standard_errors
    return wire.FittedCameraResult(
        **plain,
        pitch_deg=math.degrees(tilt.pitch),
        pitch_standard_error_deg=math.degrees(pitch_error),
        roll_deg=math.degrees(tilt.roll),
        roll_standard_error_deg=math.degrees(roll_error),
    )


def _stance(tilt: CameraTilt) -> wire.StanceResult:
    return wire.StanceResult(
        kind=wire.StanceKind(tilt.stance.value),
        probabilities={wire.StanceKind(kind.value): share for kind, share in tilt.stances.items()},
    )


def _vector(values: np.ndarray) -> wire.Vector:
    x, y, z = (float(value) for value in values)
    return (x, y, z)


def body_result(body: BodyParameters, part_names: Sequence[str]) -> wire.BodyResult:
    """Translate pose, position and shape."""
    return wire.BodyResult(
        pose=tuple(
            wire.PartRotation(part=part, rotation=_vector(rotation))
            for part, rotation in zip(part_names, body.pose, strict=True)
        ),
        translation_m=_vector(body.translation),
        shape=tuple(float(coefficient) for coefficient in body.shape),
    )


def _light(light: Light) -> wire.LightResult:
    return wire.LightResult(
        kind=wire_request.LightKind(light.kind.value),
        azimuth_deg=math.degrees(light.azimuth),
        elevation_deg=math.degrees(light.elevation),
        distance_m=None if light.kind is LightKind.DIRECTIONAL else light.distance,
        surroundings=None if light.surroundings is None else _surroundings(light.surroundings),
    )


def _surroundings(surroundings: Surroundings) -> wire.SurroundingsResult:
    e0, e1, e2, e3, e4, e5, e6, e7, e8 = surroundings.tolist()
    return wire.SurroundingsResult(coefficients=(e0, e1, e2, e3, e4, e5, e6, e7, e8))


def _reflectance(reflectance: Reflectance) -> wire.ReflectanceResult:
    return wire.ReflectanceResult(
        ambient=float(reflectance.ambient),
        specular_exponent=float(reflectance.specular_exponent),
        mean_albedo=float(reflectance.albedo.mean()),
        mean_specularity=float(reflectance.specularity.mean()),
    )


def measurement_results(
    measurements: Sequence[Measurement], given: Sequence[str]
) -> tuple[wire.Measurement, ...]:
    """Translate measurements; ``given`` names those that were in the request."""
    return tuple(
        wire.Measurement(
            name=measurement.name,
            value=measurement.value,
            unit=measurement.unit,
            standard_error=measurement.standard_error,
            given=measurement.name in given,
            definition=measurement.definition,
            source=measurement.source,
        )
        for measurement in measurements
    )


def _stage(stage: FitStage, part_names: Sequence[str], given: Sequence[str]) -> wire.Stage:
    (body,) = stage.bodies
    return wire.Stage(
        name=stage.name,
        energies=dict(stage.energies),
        silhouette_overlap=body.silhouette_overlap,
        body=body_result(body.body, part_names),
        measurements=tuple(
            wire.StageMeasurement(**each.model_dump())
            for each in measurement_results(stage.measurements, given)
        ),
    )


def _limb_facing(facing: LimbFacing) -> wire.LimbFacing:
    return wire.LimbFacing(
        limb=facing.limb,
        facing=wire_request.Facing(facing.facing.value),
        source=wire.FacingSource(facing.source.value),
        ambiguous=facing.ambiguous,
        alternative_energy=facing.alternative_energy,
    )
