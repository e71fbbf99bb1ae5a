"""A scan's request and its faults say the same in both languages."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from api_schemas.points import Point
from api_schemas.scans import ScanOptions
from fitter import request as fitter_request
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.fits.progress import Progress, Stage
from fitter.vocabulary.choices import ViewKind
from service.engine.port import Report
from service.worker import scanning
from service.worker.pipeline_port import ScanInput, ScanPicture, UnusableInputError

SCAN: dict[str, Any] = {
    "gender": "female",
    "height_m": 1.65,
    "weight_kg": 60.5,
    "cues": "SE",
    "force": True,
    "views": [
        {"view": "front", "points": {"nose": [10, 20]}, "clothing": "loose"},
        {"view": "side", "points": {}, "complete_points": True, "focal_length_35mm": 26},
    ],
}


class EndedError(Exception):
    """Ends a scan once it has been asked for."""


def job() -> ScanInput:
    pictures = tuple(ScanPicture(image=bytes([number]), mask=None) for number in range(2))
    options = ScanOptions.model_validate_json(json.dumps(SCAN))
    return ScanInput(options=options, pictures=pictures, max_pixels=7)


def asked(monkeypatch: pytest.MonkeyPatch, fault: Exception) -> fitter_request.FitRequest:
    """What the fitter is asked for by a scan that ends in this fault."""
    requests: list[fitter_request.FitRequest] = []

    def fit(given: fitter_request.FitRequest, *_: object, **__: object) -> None:
        requests.append(given)
        raise fault

    monkeypatch.setattr(scanning, "fit", fit)
    with pytest.raises((EndedError, UnusableInputError)):
        scanning.scanned(job(), lambda _: None)
    (request,) = requests
    return request


def test_the_fitter_is_asked_of_the_person_once_and_of_every_view(monkeypatch):
    request = asked(monkeypatch, EndedError())
    person, choices, (front, side) = request.person, request.choices, request.views
    assert (front.kind, side.kind) == (ViewKind.FRONT, ViewKind.SIDE)
    for number, view in enumerate((front, side)):
        assert (view.image, view.mask) == (bytes([number]), None)
        assert view.cues is fitter_request.Cues.SE
    assert (person.gender, person.height_m) == (fitter_request.Gender.FEMALE, 1.65)
    assert person.measurements["weight"].value == 60.5
    assert (choices.force, choices.max_pixels) == (True, 7)
    assert choices.optimizer is fitter_request.OptimizerKind.GAUSS_NEWTON
    point = Point(x=10.0, y=20.0)
    assert (front.clicks["nose"].x, front.clicks["nose"].y) == (point.x, point.y)
    assert front.clothing is fitter_request.Clothing.LOOSE
    assert side.clothing is fitter_request.Clothing.TIGHT
    assert (front.complete_clicks, side.complete_clicks) == (False, True)
    assert (front.focal_length_35mm, side.focal_length_35mm) == (None, 26.0)


def told(monkeypatch: pytest.MonkeyPatch, fault: Exception) -> UnusableInputError:
    def fit(*_: object, **__: object) -> None:
        raise fault

    monkeypatch.setattr(scanning, "fit", fit)
    with pytest.raises(UnusableInputError) as caught:
        scanning.scanned(job(), lambda _: None)
    return caught.value


@pytest.mark.parametrize("field", ["views.1.points.left_knee", "weight_kg"])
def test_faults_keep_the_fields_that_the_fitter_names(monkeypatch, field):
    fault = InvalidInputError(code="a-code", field=field, reason="Why.", remedy="What.")
    error = told(monkeypatch, fault).error
    assert (error.field, error.code) == (field, "a-code")
    assert (error.reason, error.remedy) == ("Why.", "What.")


def test_a_detector_that_is_missing_is_told_of_the_first_view_that_needs_it(monkeypatch):
    error = told(monkeypatch, DetectorUnavailableError(reason="None.", remedy="Click.")).error
    assert (error.field, error.code) == ("views.1.points", "detector-not-installed")


def test_progress_names_the_view_it_is_of(monkeypatch):
    reports: list[Report] = []

    def fit(*_: object, observer: Callable[[Progress], None], **__: object) -> None:
        observer(Progress(stage=Stage.SEGMENTATION, fraction=0.4, view=1))
        observer(Progress(stage=Stage.SHADING, fraction=0.9))
        raise EndedError

    monkeypatch.setattr(scanning, "fit", fit)
    with pytest.raises(EndedError):
        scanning.scanned(job(), reports.append)
    first, last = reports
    assert (first.view, first.stage) == (1, "segmentation")
    assert (last.view, last.stage) == (None, "shading")
    assert 0.0 < first.progress < last.progress < 1.0
