"""What the API makes of estimators' answers and troubles."""

import asyncio
import threading
from functools import partial
from unittest.mock import create_autospec

import pytest
from fastapi import FastAPI, Request

from api_schemas.problems import Problem
from api_schemas.questions import BodyRequest
from fitter.vocabulary.choices import Gender
from service.api.context import Parts as SharedParts
from service.api.context import _context as context_of
from service.api.estimators import Estimators
from service.api.events import EventFeed
from service.api.observation import ServiceMetrics
from service.api.problems import ProblemError
from service.compute.lanes import FAILED, TIMED_OUT, UNAVAILABLE
from service.compute.messages import DoneMessage, ProblemMessage, Received, TaskMessage
from service.compute.questions import BODY, FILE, QUESTION, BodyTask
from service.compute.tasks import Parts
from service.jobs.blobs import WatchedBlobs
from service.jobs.engine import JobEngine
from service.process.data_folder import Disk
from service.settings import Settings
from service.submissions.image_header import ImageHeader

TASK = BodyTask(request=BodyRequest(gender=Gender.MALE), with_glb=False)


class Troubled:
    """Answers every question with a problem, and notes what it was asked."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.asked: list[TaskMessage] = []
        self.parts: list[Parts] = []

    def __call__(self, question: TaskMessage, parts: Parts) -> Received:
        self.asked.append(question)
        self.parts.append(parts)
        return Received(ProblemMessage(problem=self.problem), {})


def troubled(problem: Problem) -> Estimators:
    return Estimators(Troubled(problem), estimators=1)


@pytest.mark.parametrize(
    ("problem", "status", "code", "retry"),
    [
        (UNAVAILABLE, 503, "estimator-unavailable", True),
        (TIMED_OUT, 503, "estimator-timeout", True),
        (FAILED, 500, "estimator-failed", False),
    ],
)
def test_an_estimator_s_troubles_are_problems(problem, status, code, retry):
    estimators = troubled(problem)
    for question in (estimators.answer(BODY, TASK), estimators.convert(b"glTF", "obj")):
        with pytest.raises(ProblemError) as caught:
            asyncio.run(question)
        assert (caught.value.problem.status, caught.value.problem.code) == (status, code)
        assert ("Retry-After" in caught.value.headers) is retry


def test_a_file_goes_along_and_comes_back():
    asked: list[tuple[TaskMessage, Parts]] = []

    def ask(question: TaskMessage, parts: Parts) -> Received:
        asked.append((question, parts))
        return Received(DoneMessage(parts=(FILE,)), {FILE: b"v 0 0 0"})

    estimators = Estimators(ask, estimators=1)
    assert asyncio.run(estimators.convert(b"glTF", "obj")) == b"v 0 0 0"
    ((question, parts),) = asked
    assert (question.task, question.parts) == ("conversion", (QUESTION, FILE))
    assert parts == {QUESTION: b'{"ending":"obj"}', FILE: b"glTF"}


def test_questions_and_headers_are_asked_for_the_tenant_of_the_request():
    told = Troubled(FAILED)
    owners: list[str] = []

    def read(owner: str, _: bytes) -> ImageHeader:
        owners.append(owner)
        return ImageHeader(media_type="image/png", width=1, height=1)

    app = FastAPI()
    app.state.parts = SharedParts(
        settings=Settings(),
        engine=create_autospec(JobEngine),
        blobs=create_autospec(WatchedBlobs),
        disk=Disk(None, reserve_bytes=0),
        estimators=Estimators(told, estimators=1),
        feed=create_autospec(EventFeed),
        metrics=create_autospec(ServiceMetrics),
        draining=threading.Event(),
        read_header_for=lambda owner: partial(read, owner),
    )
    for tenant in ("shop", "tailor"):
        context = context_of(Request({"type": "http", "app": app, "state": {"tenant": tenant}}))
        context.read_header(b"a picture")
        with pytest.raises(ProblemError):
            asyncio.run(context.estimators.answer(BODY, TASK))
    assert owners == [each.owner for each in told.asked] == ["shop", "tailor"]
