"""What a fit has found, translated to the wire."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from api_schemas import results as wire
from api_schemas import scans as wire_scan
from api_schemas.requests import FitOptions
from fitter.capture.finding import Box, Finding
from fitter.measurement.quantity import Measurement
from fitter.observation.worn import WornRegion
from fitter.parameters import (
    BodyParameters,
    CameraTilt,
    Light,
    Reflectance,
)
from fitter.person.fitted_person import FittedPerson
from fitter.remarks import Assumption, FitWarning
from fitter.render.camera import Camera
from fitter.result import FitResult, FitStage, FittedView, LimbFacing, PictureFit, StageBody
from fitter.vocabulary.choices import LightKind, ViewKind
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.points import PointName

_WORSE = (Verdict.PLAUSIBLE, Verdict.IMPLAUSIBLE, Verdict.NO_PERSON)


def result_of(
    options: FitOptions | wire_scan.ScanOptions, found: FitResult, part_names: Sequence[str]
) -> wire.FitResult | wire_scan.ScanResult:
    """Translate a result as what was asked for; its files are listed later, once they exist."""
    if isinstance(options, FitOptions):
        return fit_result(found, part_names=part_names)
    return scan_result(found, part_names=part_names)


def fit_result(result: FitResult, *, part_names: Sequence[str]) -> wire.FitResult:
    """Translate the result of one picture."""
    (view,) = result.views
    return wire.FitResult(
        **_person(result),
        **_view(view, part_names),
        view=view.kind,
        stages=tuple(
            wire.Stage(**_stage(stage, result.given), **_stage_body(body, part_names))
            for stage in result.stages
            for body in stage.bodies
        ),
        assumptions=assumption_results(view.assumptions + result.assumptions),
        warnings=warning_results(view.warnings + result.warnings),
        differences=result.differences,
    )


def scan_result(result: FitResult, *, part_names: Sequence[str]) -> wire_scan.ScanResult:
    """Translate the result of several pictures."""
    assert result.alone is not None
    worst = max((view.found for view in result.views), key=lambda each: _WORSE.index(each.verdict))
    return wire_scan.ScanResult(
        **_person(result),
        verdict=worst.verdict,
        outcome_explanation=worst.outcome_explanation,
        shape=rounded_parameters(result.shape),
        views=tuple(
            wire_scan.ScannedView(
                **_view(view, part_names),
                number=number,
                view=_announced(view),
                assumptions=assumption_results(view.assumptions),
                warnings=warning_results(view.warnings),
            )
            for number, view in enumerate(result.views)
        ),
        stages=tuple(
            wire_scan.ScanStage(
                **_stage(stage, result.given),
                views=tuple(
                    wire.StageBody(**_stage_body(body, part_names)) for body in stage.bodies
                ),
            )
            for stage in result.stages
        ),
        agreement=round(result.alone.agreement, 4),
        assumptions=assumption_results(result.assumptions),
        warnings=warning_results(result.warnings),
    )


def _person(result: FitResult) -> dict[str, Any]:
    """The fields of a :class:`api_schemas.results.PersonResult` that say one thing of all."""
    return {
        "gender": result.person.gender,
        "height_m": round(result.found.height_m, 4),
        "cues": result.found.cues,
        "optimizer": result.optimizer,
        "energies": _energies(result.energies),
        "evaluations": result.evaluations,
        "measurements": measurement_results(result.measurements, result.given),
        "stage_seconds": {name: round(each, 3) for name, each in result.stage_seconds.items()},
        "artifacts": (),
    }


def _view(view: FittedView, part_names: Sequence[str]) -> dict[str, Any]:
    """The fields of a :class:`api_schemas.results.ViewResult`."""
    found = view.found
    return _in_picture(found, part_names) | {
        "outcome_explanation": found.outcome_explanation,
        "verdict": found.verdict,
        "camera": fitted_camera(view.camera, found.person.tilt),
        "focal_length_source": view.focal_length_source,
        "stance": _stance(found.person),
        "limb_facing": tuple(_limb_facing(facing) for facing in view.limb_facing),
        "findings": finding_results(view.findings),
        "clothing": tuple(_worn(each) for each in found.clothing),
    }


def _worn(each: WornRegion) -> wire.WornRegion:
    """To a hundredth, and to half a millimetre."""
    return wire.WornRegion(
        region=each.region,
        kind=each.kind,
        probability=round(each.probability, 2),
        ease_cm=_centimetres(each.ease_m),
        ease_standard_error_cm=_centimetres(each.ease_standard_error_m),
    )


def _centimetres(metres: float | None) -> float | None:
    return None if metres is None else round(100.0 * metres, 1)


def _in_picture(found: PictureFit, part_names: Sequence[str]) -> dict[str, Any]:
    """The fields of a :class:`api_schemas.results.PictureResult`."""
    person = found.person
    return {
        "outcome": found.outcome,
        "image_camera": fitted_camera(person.camera, person.tilt),
        "body": body_result(person.body, part_names),
        "light": None if person.light is None else _light(person.light),
        "reflectance": None if person.reflectance is None else _reflectance(person.reflectance),
        "silhouette_overlap": round(found.silhouette_overlap, 4),
    }


def _announced(view: FittedView) -> ViewKind:
    assert view.kind is not None
    return view.kind


def _stage(stage: FitStage, given: Sequence[str]) -> dict[str, Any]:
    """The fields of a :class:`api_schemas.results.StageResult`."""
    return {
        "name": stage.name,
        "energies": _energies(stage.energies),
        "measurements": tuple(
            wire.StageMeasurement(**each.model_dump(exclude={"low", "high"}))
            for each in measurement_results(stage.measurements, given)
        ),
    }


def _stage_body(stage: StageBody, part_names: Sequence[str]) -> dict[str, Any]:
    """The fields of a :class:`api_schemas.results.StageBody`."""
    return {
        "silhouette_overlap": round(stage.silhouette_overlap, 4),
        "body": body_result(stage.body, part_names),
    }


def assumption_results(assumptions: Sequence[Assumption]) -> tuple[wire.Assumption, ...]:
    """Translate what was assumed."""
    return tuple(
        wire.Assumption(
            quantity=each.quantity,
            value=round(each.value, 4) if isinstance(each.value, float) else each.value,
            reason=each.reason,
        )
        for each in assumptions
    )


def warning_results(warnings: Sequence[FitWarning]) -> tuple[wire.FitWarning, ...]:
    """Translate warnings."""
    return tuple(wire.FitWarning(code=each.code, message=each.message) for each in warnings)


def finding_results(findings: Sequence[Finding]) -> tuple[wire.Finding, ...]:
    """Translate what was found; boxes to a hundredth of a pixel."""
    return tuple(
        wire.Finding(
            code=found.code.value,
            severity=found.severity,
            reason=found.reason,
            remedy=found.remedy,
            points=tuple(cast("PointName", name) for name in found.points),
            box=rounded_box(found.box),
        )
        for found in findings
    )


def rounded_box(box: Box | None) -> Box | None:
    """A box to a hundredth of a pixel."""
    if box is None:
        return None
    left, top, right, bottom = (round(each, 2) for each in box)
    return left, top, right, bottom


def camera_result(camera: Camera) -> wire.CameraResult:
    """Translate a camera."""
    return wire.CameraResult(
        focal_length_px=round(float(camera.focal_length_px), 3),
        centre_x=round(float(camera.centre_x), 3),
        centre_y=round(float(camera.centre_y), 3),
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
        pitch_deg=_degrees(tilt.pitch),
        pitch_standard_error_deg=_degrees(pitch_error),
        roll_deg=_degrees(tilt.roll),
        roll_standard_error_deg=_degrees(roll_error),
    )


def _degrees(radians: float) -> float:
    """Fine enough that what is turned by it at some metres' distance is where the files have it."""
    return round(math.degrees(radians), 5)


def _stance(person: FittedPerson) -> wire.StanceResult | None:
    if person.tilt is None:
        return None
    probabilities = {kind: round(each, 4) for kind, each in person.tilt.stances.items()}
    return wire.StanceResult(kind=person.tilt.stance, probabilities=probabilities)


def _vector(values: np.ndarray) -> wire.Vector:
    x, y, z = rounded_parameters(values)
    return (x, y, z)


def rounded_parameters(values: np.ndarray) -> tuple[float, ...]:
    """To a millionth of a radian, metre or standard deviation.

    The surface of a body that is made of them lies where the files have it, to a micrometre or two.
    """
    return tuple(round(float(value), 6) for value in values)


def _energies(energies: Mapping[str, float]) -> dict[str, float]:
    """To a hundredth of a nat."""
    return {name: round(energy, 2) for name, energy in energies.items()}


def body_result(body: BodyParameters, part_names: Sequence[str]) -> wire.BodyResult:
    """Translate pose, position and shape."""
    return wire.BodyResult(
        pose=tuple(
            wire.PartRotation(part=part, rotation=_vector(rotation))
            for part, rotation in zip(part_names, body.pose, strict=True)
        ),
        translation_m=_vector(body.translation),
        shape=rounded_parameters(body.shape),
    )


def _light(light: Light) -> wire.LightResult:
    return wire.LightResult(
        kind=light.kind,
        azimuth_deg=_degrees(light.azimuth),
        elevation_deg=_degrees(light.elevation),
        distance_m=None if light.kind is LightKind.DIRECTIONAL else round(light.distance, 3),
    )


def _reflectance(reflectance: Reflectance) -> wire.ReflectanceResult:
    return wire.ReflectanceResult(
        ambient=round(float(reflectance.ambient), 4),
        specular_exponent=round(float(reflectance.specular_exponent), 2),
        mean_albedo=round(float(reflectance.albedo.mean()), 4),
        mean_specularity=round(float(reflectance.specularity.mean()), 4),
    )


def measurement_results(
    measurements: Sequence[Measurement], given: Sequence[str]
) -> tuple[wire.Measurement, ...]:
    """Translate measurements, to a tenth of a millimetre and to 10 grams.

    ``given`` names those that were in the request.
    """
    return tuple(
        wire.Measurement(
            name=measurement.name,
            value=round(measurement.value, 2),
            unit=measurement.unit,
            standard_error=_rounded_error(measurement.standard_error),
            given=measurement.name in given,
            definition=measurement.definition,
            source=measurement.source,
        )
        for measurement in measurements
    )


def _rounded_error(error: float | None) -> float | None:
    """To a hundredth of a millimetre, so that none but those of exact values are zero."""
    return None if error is None else round(error, 3)


def _limb_facing(facing: LimbFacing) -> wire.LimbFacing:
    return wire.LimbFacing(
        limb=facing.limb,
        facing=facing.facing,
        source=facing.source,
        ambiguous=facing.ambiguous,
        alternative_energy=None
        if facing.alternative_energy is None
        else round(facing.alternative_energy, 2),
    )
