"""The pipeline hands the fitter what was asked of one or several pictures, and tells its faults."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.fits.progress import Progress, Stage
from fitter.request import Click, FitRequest
from fitter.vocabulary.choices import Clothing, ViewKind
from service.compute import pipeline
from service.compute.tasks import OPTIONS, ChildSetup, Observe, UnusableInputError
from service.jobs.inputs import SentPicture, named_pictures, pictures_of
from service.jobs.records import Report

PERSON: dict[str, Any] = {
    "gender": "female",
    "height_m": 1.65,
    "weight_kg": 60.5,
    "cues": "SE",
    "optimizer": "simplex",
    "force": True,
}
FRONT: dict[str, Any] = {"view": "front", "points": {"nose": [10, 20]}, "clothing": "loose"}
SIDE: dict[str, Any] = {
    "view": "side",
    "points": {},
    "complete_points": True,
    "focal_length_35mm": 26,
}


SETUP = ChildSetup(name="job", max_pixels=7)
NAMED = named_pictures([SentPicture(bytes([number]), None) for number in range(2)])


def ended_fit(*, pictures: int = 2, observe: Observe = lambda _: None) -> None:
    asked = PERSON | {"views": [FRONT, SIDE][:pictures]}
    # As they come from storage: in no order.
    files = dict(reversed(list(NAMED.items())[:pictures]))
    pipeline.fit_task(SETUP, {OPTIONS: json.dumps(asked).encode(), **files}, observe)


class EndedError(Exception):
    """Ends a fit once it has been asked for."""


def asked(monkeypatch: pytest.MonkeyPatch, fault: Exception, *, pictures: int) -> FitRequest:
    """What the fitter is asked for by a fit that ends in this fault."""
    requests: list[FitRequest] = []

    def fit(request: FitRequest, *_: object, **__: object) -> None:
        requests.append(request)
        raise fault

    monkeypatch.setattr(pipeline, "fit", fit)
    with pytest.raises((EndedError, UnusableInputError)):
        ended_fit(pictures=pictures)
    (request,) = requests
    return request


def test_of_every_picture_the_fitter_is_told_what_was_said_of_it(monkeypatch):
    front, side = asked(monkeypatch, EndedError(), pictures=2).views
    (alone,) = asked(monkeypatch, EndedError(), pictures=1).views
    assert (front.kind, side.kind, alone.kind) == (ViewKind.FRONT, ViewKind.SIDE, ViewKind.FRONT)
    assert front.clicks == alone.clicks == {"nose": Click(x=10.0, y=20.0)}
    assert front.clothing is alone.clothing is Clothing.LOOSE
    assert side.clothing is Clothing.AUTO
    assert (front.complete_clicks, side.complete_clicks) == (False, True)
    assert (front.focal_length_35mm, side.focal_length_35mm) == (None, 26.0)


def told(monkeypatch: pytest.MonkeyPatch, fault: Exception) -> Any:
    def fit(*_: object, **__: object) -> None:
        raise fault

    monkeypatch.setattr(pipeline, "fit", fit)
    with pytest.raises(UnusableInputError) as caught:
        ended_fit()
    return caught.value.error


def test_a_fault_keeps_its_words(monkeypatch):
    fault = InvalidInputError(code="a-code", field="views.1.image", reason="Why.", remedy="What.")
    error = told(monkeypatch, fault)
    assert (error.field, error.code) == ("views.1.image", "a-code")
    assert (error.reason, error.remedy) == ("Why.", "What.")


def test_a_detector_that_is_missing_is_told_of_the_first_picture_that_needs_it(monkeypatch):
    fault = DetectorUnavailableError(reason="None.", remedy="Click.")
    error = told(monkeypatch, fault)
    assert (error.field, error.code) == ("views.1.points", "detector-not-installed")


def test_progress_names_the_view_it_is_of(monkeypatch):
    reports: list[Report] = []

    def fit(*_: object, observer: Callable[[Progress], None], **__: object) -> None:
        observer(Progress(view=1, stage=Stage.SEGMENTATION, fraction=0.4))
        observer(Progress(stage=Stage.SHADING, fraction=0.9, energies={"edges": 2.0}))
        raise EndedError

    monkeypatch.setattr(pipeline, "fit", fit)
    with pytest.raises(EndedError):
        ended_fit(observe=reports.append)
    assert reports == [
        Report(view=1, stage="segmentation", progress=0.4),
        Report(stage="shading", progress=0.9, energies={"edges": 2.0}),
    ]


def test_names_of_pictures_say_of_which_view_they_are():
    one, other = SentPicture(b"f", None), SentPicture(b"s", b"m")
    assert named_pictures([one, other]) == {
        "views/0/image": b"f",
        "views/1/image": b"s",
        "views/1/mask": b"m",
    }
    for pictures in ([other], [one, other], [one] * 6):
        assert pictures_of(named_pictures(pictures)) == tuple(pictures)
