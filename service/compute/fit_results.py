"""The result of a fit, translated to the wire."""

import math
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from api_schemas import results as wire
from fitter.measurement.definitions import Measurement
from fitter.parameters import BodyParameters, CameraTilt, Light, Reflectance
from fitter.render.camera import Camera
from fitter.result import FitResult, FitStage, FittedView
from fitter.vocabulary.choices import LightKind
from fitter.vocabulary.outcomes import Verdict

_WORSE = (Verdict.PLAUSIBLE, Verdict.IMPLAUSIBLE, Verdict.NO_PERSON)

WITHIN_95 = 1.96
"""So many standard errors to either side hold 95 % of true values."""


def fit_result(result: FitResult, *, part_names: Sequence[str]) -> wire.FitResult:
    """Translate a result; its files are listed later, once they exist."""
    worst = max((view.found for view in result.views), key=lambda each: _WORSE.index(each.verdict))
    return wire.FitResult(
        gender=result.person.gender,
        height_m=round(result.found.height_m, 4),
        cues=result.found.cues,
        optimizer=result.optimizer,
        energies=_energies(result.energies),
        evaluations=result.evaluations,
        measurements=measurement_results(result.measurements, result.given),
        shape=rounded_parameters(result.shape),
        verdict=worst.verdict,
        outcome_explanation=worst.outcome_explanation,
        agreement=None if result.alone is None else round(result.alone.agreement, 4),
        assumptions=result.assumptions,
        warnings=result.warnings,
        differences=result.differences,
        stages=tuple(_stage(stage) for stage in result.stages),
        stage_seconds={name: round(each, 3) for name, each in result.stage_seconds.items()},
        files=(),
        views=tuple(_view(view, part_names) for view in result.views),
    )


def _view(view: FittedView, part_names: Sequence[str]) -> wire.ViewResult:
    found, person = view.found, view.found.person
    return wire.ViewResult(
        view=view.kind,
        outcome=found.outcome,
        verdict=found.verdict,
        camera=camera_result(view.camera),
        image_camera=camera_result(person.camera),
        focal_length_source=view.focal_length_source,
        body=body_result(person.body, part_names),
        light=None if person.light is None else _light(person.light),
        reflectance=None if person.reflectance is None else _reflectance(person.reflectance),
        silhouette_overlap=round(found.silhouette_overlap, 4),
        tilt=None if person.tilt is None else _tilt(person.tilt),
        limb_facing=view.limb_facing,
        findings=view.findings,
        clothing=found.clothing,
        assumptions=view.assumptions,
        warnings=view.warnings,
    )


def _stage(stage: FitStage) -> wire.Stage:
    return wire.Stage(
        name=stage.name,
        energies=_energies(stage.energies),
        measurements={each.name: round(each.value, 2) for each in stage.measurements},
    )


def camera_result(camera: Camera) -> wire.CameraResult:
    """Translate a camera."""
    return wire.CameraResult(
        focal_length_px=round(float(camera.focal_length_px), 3),
        centre_x=round(float(camera.centre_x), 3),
        centre_y=round(float(camera.centre_y), 3),
        width=camera.width,
        height=camera.height,
    )


def _tilt(tilt: CameraTilt) -> wire.TiltResult:
    pitch_error, roll_error = tilt.standard_errors
    return wire.TiltResult(
        pitch_deg=_degrees(tilt.pitch),
        pitch_standard_error_deg=_degrees(pitch_error),
        roll_deg=_degrees(tilt.roll),
        roll_standard_error_deg=_degrees(roll_error),
        stance=tilt.stance,
        stances={kind: round(each, 4) for kind, each in tilt.stances.items()},
    )


def _degrees(radians: float) -> float:
    """Fine enough that what is turned by it at some metres' distance is where the files have it."""
    return round(math.degrees(radians), 5)


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
        pose={part: _vector(turn) for part, turn in zip(part_names, body.pose, strict=True)},
        translation_m=_vector(body.translation),
        shape=rounded_parameters(body.shape),
    )


def _light(light: Light) -> wire.Light:
    return wire.Light(
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
    measurements: Sequence[Measurement], given: Collection[str]
) -> tuple[wire.Measurement, ...]:
    """Translate measurements, to a tenth of a millimetre and to 10 grams.

    ``given`` names those that were in the request.
    """
    return tuple(_measurement(each, is_given=each.name in given) for each in measurements)


def _measurement(measurement: Measurement, *, is_given: bool) -> wire.Measurement:
    value = round(measurement.value, 2)
    error = measurement.standard_error
    # To a hundredth of a millimetre, so that none but those of exact values are zero.
    error = None if error is None else round(error, 3)
    return wire.Measurement(
        name=measurement.name,
        value=value,
        unit=measurement.unit,
        standard_error=error,
        low=None if error is None else round(max(value - WITHIN_95 * error, 0.0), 2),
        high=None if error is None else round(value + WITHIN_95 * error, 2),
        given=is_given,
        definition=measurement.definition,
        source=measurement.source,
    )
