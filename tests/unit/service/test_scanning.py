"""A scan's request and its faults say the same in both languages."""

import json
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from api_schemas.points import Point
from api_schemas.scans import ScanOptions
from fitter import request as fitter_request
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.fits.progress import Stage
from fitter.fits.scan import ScanProgress, ScanView, ViewKind
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


def asked(monkeypatch: pytest.MonkeyPatch, fault: Exception) -> Sequence[ScanView]:
    """What the fitter is asked for by a scan that ends in this fault."""
    views: list[ScanView] = []

    def scan(given: Sequence[ScanView], **_: object) -> None:
        views.extend(given)
        raise fault

    monkeypatch.setattr(scanning, "scan", scan)
    with pytest.raises((EndedError, UnusableInputError)):
        scanning.scanned(job(), lambda _: None)
    return views


def test_the_fitter_is_asked_the_same_of_the_person_in_every_view(monkeypatch):
    front, side = asked(monkeypatch, EndedError())
    assert (front.kind, side.kind) == (ViewKind.FRONT, ViewKind.SIDE)
    for number, view in enumerate((front, side)):
        request = view.request
        assert (request.image, request.mask, request.max_pixels) == (bytes([number]), None, 7)
        assert (request.gender, request.height_m) == (fitter_request.Gender.FEMALE, 1.65)
        assert request.measurements["weight"].value == 60.5
        assert (request.cues, request.force) == (fitter_request.Cues.SE, True)
        assert request.optimizer is fitter_request.OptimizerKind.GAUSS_NEWTON
    point = Point(x=10.0, y=20.0)
    assert (front.request.clicks["nose"].x, front.request.clicks["nose"].y) == (point.x, point.y)
    assert front.request.clothing is fitter_request.Clothing.LOOSE
    assert side.request.clothing is fitter_request.Clothing.TIGHT
    assert (front.request.complete_clicks, side.request.complete_clicks) == (False, True)
    assert (front.request.focal_length_35mm, side.request.focal_length_35mm) == (None, 26.0)


def told(monkeypatch: pytest.MonkeyPatch, fault: Exception) -> UnusableInputError:
    def scan(*_: object, **__: object) -> None:
        raise fault

    monkeypatch.setattr(scanning, "scan", scan)
    with pytest.raises(UnusableInputError) as caught:
        scanning.scanned(job(), lambda _: None)
    return caught.value


@pytest.mark.parametrize(
    ("field", "expected"),
    [
        ("views.1.image", "views.1.image"),
        ("views.1.points.left_knee", "views.1.points.left_knee"),
        ("views.0.focal_length_px", "views.0.focal_length_px"),
        ("views.0.height_m", "height_m"),
        ("views.1.measurements.hip_girth", "measurements.hip_girth"),
        ("views.0.weight_kg", "weight_kg"),
        ("views", "views"),
        ("measurements", "measurements"),
    ],
)
def test_faults_of_the_person_are_the_scans_and_others_their_views(monkeypatch, field, expected):
    fault = InvalidInputError(code="a-code", field=field, reason="Why.", remedy="What.")
    error = told(monkeypatch, fault).error
    assert (error.field, error.code) == (expected, "a-code")
    assert (error.reason, error.remedy) == ("Why.", "What.")


def test_a_detector_that_is_missing_is_told_of_the_first_view_that_needs_it(monkeypatch):
    error = told(monkeypatch, DetectorUnavailableError(reason="None.", remedy="Click.")).error
    assert (error.field, error.code) == ("views.1.points", "detector-not-installed")


def test_progress_names_the_view_it_is_of(monkeypatch):
    reports: list[Report] = []

    def scan(*_: object, observe: Callable[[ScanProgress], None], **__: object) -> None:
        observe(ScanProgress(view=1, stage=Stage.SEGMENTATION, fraction=0.4))
        observe(ScanProgress(view=None, stage=Stage.SHADING, fraction=1.0))
        raise EndedError

    monkeypatch.setattr(scanning, "scan", scan)
    with pytest.raises(EndedError):
        scanning.scanned(job(), reports.append)
    first, last = reports
    assert (first.view, first.stage) == (1, "segmentation")
    assert (last.view, last.stage) == (None, "shading")
    assert 0.0 < first.progress < last.progress < 1.0
