"""Between the wire types of estimates and the fitter's: pure, both ways, nothing else."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from api_schemas import bodies as wire_bodies
from api_schemas import initial_poses as wire_poses
from api_schemas import requests as wire_request
from api_schemas import results as wire_results
from api_schemas.known import STATURE
from fitter.body.model import BodyModel
from fitter.fits.initial_body import InitialBody
from fitter.population.body_estimate import BodyEstimate
from fitter.request import Facing, FitRequest, Gender
from service.worker.translate import body_result, camera_result, clicks, known_measurements


def wire_gender(gender: Gender) -> wire_request.Gender:
    """Translate a gender."""
    return wire_request.Gender(gender.value)


def subject_request(subject: wire_request.SubjectOptions) -> FitRequest:
    """Translate a subject whose points are named; there is no picture."""
    return FitRequest(
        image=b"",
        clicks=clicks(subject.points),
        gender=Gender(subject.gender),
        height_m=subject.height_m,
        measurements=known_measurements(subject),
        focal_length_px=subject.focal_length_px,
        focal_length_35mm=subject.focal_length_35mm,
        limb_facing={limb.value: Facing(facing) for limb, facing in subject.limb_facing.items()},
    )


def initial_pose(
    initial: InitialBody, request: FitRequest, part_names: Sequence[str]
) -> wire_poses.InitialPose:
    """Translate an initial body."""
    return wire_poses.InitialPose(
        gender=wire_gender(request.gender),
        height_m=initial.height_m,
        camera=camera_result(initial.camera),
        focal_length_source=wire_results.FocalLengthSource(initial.focal_length_source.value),
        body=body_result(initial.body, part_names),
        outline=tuple(tuple(_pixel(corner) for corner in loop) for loop in initial.outline),
        points={name: _pixel(place) for name, place in initial.landmarks.items()},
        residual_px={name: float(value) for name, value in initial.residual_px.items()},
        limbs=tuple(
            wire_poses.LimbReading(
                limb=reading.limb,
                facing=wire_request.Facing(reading.facing.value),
                ambiguous=reading.ambiguous,
                alternative_nats=reading.alternative_nats,
            )
            for reading in initial.limbs
        ),
        assumptions=tuple(
            wire_results.Assumption(quantity=each.quantity, value=each.value, reason=each.reason)
            for each in initial.assumptions
        ),
        warnings=tuple(
            wire_results.FitWarning(code=each.code, message=each.message)
            for each in initial.warnings
        ),
    )


def body_estimate(estimate: BodyEstimate, model: BodyModel) -> wire_bodies.BodyEstimate:
    """Translate an estimated body; the caller adds its file."""
    measurements = tuple(
        wire_bodies.EstimatedMeasurement(
            name=each.measurement.name,
            value=each.measurement.value,
            unit=each.measurement.unit,
            standard_error=each.measurement.standard_error or 0.0,
            low=each.low,
            high=each.high,
            given=each.given,
            definition=each.measurement.definition,
            source=each.measurement.source,
        )
        for each in estimate.measurements
    )
    stature_cm = next(each.value for each in measurements if each.name == STATURE)
    return wire_bodies.BodyEstimate(
        gender=wire_request.Gender(model.gender),
        height_m=stature_cm / 100.0,
        shape=tuple(float(coefficient) for coefficient in estimate.shape),
        measurements=measurements,
        plausibility=estimate.plausibility,
        body_model=str(model.header.get("checksum", "")),
    )


def _pixel(place: Float[np.ndarray, "2"]) -> tuple[float, float]:
    """Rounded to a hundredth: an outline has hundreds of corners, drawn on whole pixels."""
    return round(float(place[0]), 2), round(float(place[1]), 2)
