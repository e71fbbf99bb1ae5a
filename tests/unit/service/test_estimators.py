"""What the API makes of estimators' answers and troubles."""

import asyncio

import pytest

from api_schemas.problems import Problem
from api_schemas.questions import BodyRequest, PointsRequest
from fitter.vocabulary.choices import Gender
from service.api.estimators import Estimators
from service.api.observation import ServiceMetrics
from service.api.problems import ProblemError
from service.compute.lanes import FAILED, TIMED_OUT, UNAVAILABLE
from service.compute.messages import DoneMessage, ProblemMessage, Received, TaskMessage
from service.compute.questions import BODY, FILE, POINTS, QUESTION, BodyTask
from service.compute.tasks import Parts
from service.process.data_folder import Disk
from service.submissions.submission import no_detector

TASK = BodyTask(request=BodyRequest(gender=Gender.MALE), with_glb=False)


class NoEngine:
    """No figures but those counted here are asked for."""


METRICS = ServiceMetrics(NoEngine(), Disk(None, reserve_bytes=0))


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
    return Estimators(Troubled(problem), METRICS, estimators=1)


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


def test_a_detector_that_is_not_there_is_told_with_what_to_install():
    with pytest.raises(ProblemError) as caught:
        asyncio.run(troubled(no_detector()).answer(POINTS, PointsRequest(), b"a picture"))
    told = caught.value.problem
    assert (told.status, told.code) == (404, "detector-not-installed")
    assert "pip install" in told.remedy


def test_a_file_goes_along_and_comes_back():
    asked: list[tuple[TaskMessage, Parts]] = []

    def ask(question: TaskMessage, parts: Parts) -> Received:
        asked.append((question, parts))
        return Received(DoneMessage(parts=(FILE,)), {FILE: b"v 0 0 0"})

    estimators = Estimators(ask, METRICS, estimators=1)
    assert asyncio.run(estimators.convert(b"glTF", "obj")) == b"v 0 0 0"
    ((question, parts),) = asked
    assert (question.task, question.parts) == ("conversion", (QUESTION, FILE))
    assert parts == {QUESTION: b'{"ending":"obj"}', FILE: b"glTF"}
