"""Translate what is asked for to the fitter's types, and its faults and progress back."""

import math
from collections.abc import Sequence

from api_schemas.fit import FitRequest as AskedFit
from api_schemas.person import Person as AskedPerson
from api_schemas.person import UncertainMeasurement
from api_schemas.picture import ClothingByRegion, ViewRequest
from api_schemas.points import Point, Points, PointSource, named_points
from api_schemas.problems import FieldProblem
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
from fitter.vocabulary.choices import Cues
from fitter.vocabulary.measurements import WEIGHT
from service.jobs.inputs import SentPicture
from service.jobs.records import Report
from service.submissions.submission import DETECTOR_MISSING

SEEN = 2


def fit_request(
    asked: AskedFit, pictures: Sequence[SentPicture[bytes]], *, max_pixels: int
) -> FitRequest:
    """Translate a request whose points are named, and its encoded pictures in their order."""
    return FitRequest(
        person=person(asked),
        views=tuple(
            _view(view, asked.cues, sent) for view, sent in zip(asked.views, pictures, strict=True)
        ),
        choices=Choices(
            optimizer=asked.optimizer,
            paper=_paper(asked),
            force=asked.force,
            max_pixels=max_pixels,
        ),
    )


def _paper(asked: AskedFit) -> Paper | None:
    if asked.paper is None:
        return None
    return Paper(energies=frozenset(asked.paper.energies), free_height=asked.paper.free_height)


def person(asked: AskedPerson) -> Person:
    """Translate what is said of the person."""
    return Person(
        gender=asked.gender,
        height_m=asked.height_m,
        measurements=known_measurements(asked),
    )


def _view(asked: ViewRequest, cues: Cues, sent: SentPicture[bytes]) -> View:
    clothing = asked.clothing
    if isinstance(clothing, ClothingByRegion):
        clothing = SaidClothing(upper=clothing.upper, lower=clothing.lower)
    return View(
        image=sent.image,
        mask=sent.mask,
        kind=asked.view,
        clicks=clicks(asked.given_points),
        focal_length_px=asked.focal_length_px,
        focal_length_35mm=asked.focal_length_35mm,
        cues=cues,
        clothing=clothing,
        complete_clicks=asked.are_points_completed,
        light=LightGuess(
            kind=asked.light.kind,
            azimuth=_radians(asked.light.azimuth_deg),
            elevation=_radians(asked.light.elevation_deg),
            distance=asked.light.distance_m,
        ),
        limb_facing={limb.value: facing for limb, facing in asked.limb_facing.items()},
    )


def clicks(points: Points) -> dict[str, Click]:
    """Translate named points; proposed ones get the spread of proposals of that name."""
    return {name: _click(name, point) for name, point in named_points(points).items()}


def known_measurements(known: AskedPerson) -> dict[str, KnownMeasurement]:
    """Translate what is known besides the height, by measurement name, each in its unit."""
    measurements = {
        name: KnownMeasurement(value=given.value, standard_error=given.standard_error)
        if isinstance(given, UncertainMeasurement)
        else KnownMeasurement(value=given)
        for name, given in known.measurements.items()
    }
    if known.weight_kg is None:
        return measurements
    return {WEIGHT: KnownMeasurement(value=known.weight_kg, field="weight_kg")} | measurements


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


def proposed_field(asked: AskedFit) -> str:
    """The first field that asks for points to be proposed."""
    place = next(place for place, view in enumerate(asked.views) if view.are_points_completed)
    return f"views.{place}.points"


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
