"""Translate what is asked for to the fitter's types, and its faults and progress back."""

import math
from collections.abc import Sequence

from api_schemas import known as wire_known
from api_schemas import requests as wire
from api_schemas.points import Point, Points, PointSource, points_by_name
from api_schemas.problems import FieldProblem
from api_schemas.scans import ScanOptions, ScanViewOptions
from fitter.detection.landmark_meanings import INDEX_OF_POINT, UNSEEN_CONFIDENCE, spread_m
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.fits.progress import Progress
from fitter.request import (
    Choices,
    Click,
    FitRequest,
    KnownMeasurement,
    LightGuess,
    Paper,
    Person,
    SaidClothing,
    View,
)
from fitter.vocabulary.choices import Clothing, Cues
from service.engine.port import Report
from service.jobs.inputs import SentPicture
from service.submissions.detector import DETECTOR_MISSING

SEEN = 2


def fit_request(
    options: wire.FitOptions | ScanOptions,
    pictures: Sequence[SentPicture[bytes]],
    *,
    max_pixels: int,
) -> FitRequest:
    """Translate a request whose points are named, and its encoded pictures in their order."""
    return FitRequest(
        person=person(options),
        views=views(options, pictures),
        choices=Choices(
            optimizer=options.optimizer,
            paper=_paper(options),
            force=options.force,
            max_pixels=max_pixels,
        ),
    )


def _paper(options: wire.FitOptions | ScanOptions) -> Paper | None:
    asked = options.paper if isinstance(options, wire.FitOptions) else None
    if asked is None:
        return None
    return Paper(energies=frozenset(asked.energies), free_height=asked.free_height)


def person(asked: wire.Person) -> Person:
    """Translate what is said of the person."""
    return Person(
        gender=asked.gender,
        height_m=asked.height_m,
        measurements=known_measurements(asked),
    )


def views(
    options: wire.FitOptions | ScanOptions, pictures: Sequence[SentPicture[bytes]]
) -> tuple[View, ...]:
    """Translate what is said of each picture."""
    return tuple(
        _view(asked, options.cues, sent)
        for asked, sent in zip(options.pictures, pictures, strict=True)
    )


def _view(asked: wire.FitOptions | ScanViewOptions, cues: Cues, sent: SentPicture[bytes]) -> View:
    return View(
        image=sent.image,
        mask=sent.mask,
        kind=asked.view,
        clicks=clicks(asked.points),
        focal_length_px=asked.focal_length_px,
        focal_length_35mm=asked.focal_length_35mm,
        cues=cues,
        clothing=_clothing(asked),
        complete_clicks=asked.complete_points,
        segmentation=asked.segmentation,
        slant_hints=asked.slant_hints,
        light=LightGuess(
            kind=asked.light.kind,
            azimuth=_radians(asked.light.azimuth_deg),
            elevation=_radians(asked.light.elevation_deg),
            distance=asked.light.distance_m,
        ),
        limb_facing={limb.value: facing for limb, facing in asked.limb_facing.items()},
    )


def _clothing(asked: wire.PictureChoices) -> Clothing | SaidClothing:
    by_region = asked.clothing_by_region
    if by_region is None:
        return asked.clothing
    return SaidClothing(upper=by_region.upper, lower=by_region.lower)


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


def detector_problem(error: DetectorUnavailableError, *, field: str = "points") -> FieldProblem:
    """Say that points were to be proposed but there is no detector."""
    return FieldProblem(
        field=field, code=DETECTOR_MISSING, reason=error.reason, remedy=error.remedy
    )


def proposed_field(options: wire.FitOptions | ScanOptions) -> str:
    """The first field that asks for points to be proposed."""
    if len(options.pictures) == 1:
        return "points"
    first = next(place for place, asked in enumerate(options.pictures) if asked.complete_points)
    return f"views.{first}.points"


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
