"""What the API makes of an estimator's answers and troubles."""

import asyncio

import pytest

from api_schemas.bodies import BodyRequest
from api_schemas.checks import CaptureCheck, CheckRequest
from api_schemas.initial_poses import InitialPose
from api_schemas.problems import FieldProblem
from api_schemas.proposals import PointsRequest
from fitter.vocabulary.choices import Gender
from service.api.estimates import Estimates
from service.api.metrics import ServiceMetrics
from service.api.problems import ProblemError
from service.estimates.messages import (
    BodyTask,
    CheckTask,
    ConversionTask,
    InitialPoseTask,
    PointsTask,
)
from service.estimates.port import (
    EstimatedBody,
    EstimatorFailedError,
    EstimatorTimeoutError,
    EstimatorUnavailableError,
    NoDetectorError,
    ProposedPoints,
)
from service.process.disk import Disk
from service.representation.formats import OBJ
from service.submissions.refusal import RefusedError, refused

TASK = BodyTask(request=BodyRequest(gender=Gender.MALE), with_glb=False)
NOBODY = refused(
    FieldProblem(field="weight_kg", code="contradictory-measurements", reason="No.", remedy="Yes.")
)


class NoEngine:
    """No figures but those counted here are asked for."""


METRICS = ServiceMetrics(NoEngine(), Disk(None, reserve_bytes=0))


class RaisingEstimator:
    """Raises the given error at every question; notes whether it was asked patiently."""

    capacity = 1

    def __init__(self, error: Exception) -> None:
        self.error = error
        self.patient: bool | None = None

    def body(self, task: BodyTask, *, patient: bool = True) -> EstimatedBody:
        self.patient = patient
        raise self.error

    def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        raise self.error

    def points(self, task: PointsTask, image: bytes) -> ProposedPoints:
        raise self.error

    def check(self, task: CheckTask, image: bytes) -> CaptureCheck:
        raise self.error

    def jpeg(self, image: bytes) -> bytes:
        raise AssertionError

    def convert(self, task: ConversionTask, glb: bytes) -> bytes:
        raise self.error


@pytest.mark.parametrize(
    ("error", "status", "code", "retry"),
    [
        (EstimatorUnavailableError(), 503, "estimator-unavailable", True),
        (EstimatorTimeoutError(), 503, "estimator-timeout", True),
        (EstimatorFailedError(), 500, "estimator-failed", False),
    ],
)
def test_an_estimator_s_troubles_are_problems(error, status, code, retry):
    estimates = Estimates(RaisingEstimator(error), METRICS)
    for question in (estimates.body(TASK), estimates.convert(b"glTF", OBJ)):
        with pytest.raises(ProblemError) as caught:
            asyncio.run(question)
        assert (caught.value.problem.status, caught.value.problem.code) == (status, code)
        assert ("Retry-After" in caught.value.headers) is retry


def test_a_detector_that_is_not_there_is_told_with_what_to_install():
    estimates = Estimates(RaisingEstimator(NoDetectorError()), METRICS)
    for question in (
        estimates.points(PointsTask(request=PointsRequest()), b"a picture"),
        estimates.check(CheckTask(request=CheckRequest()), b"a picture"),
    ):
        with pytest.raises(ProblemError) as caught:
            asyncio.run(question)
        told = caught.value.problem
        assert (told.status, told.code) == (404, "detector-not-installed")
        assert "pip install" in told.remedy


def test_who_is_nobody_is_refused_and_other_troubles_are_left_to_the_job():
    with pytest.raises(RefusedError):
        asyncio.run(Estimates(RaisingEstimator(NOBODY), METRICS).refuse_nobody(TASK))
    for error in (EstimatorUnavailableError(), EstimatorTimeoutError(), EstimatorFailedError()):
        estimator = RaisingEstimator(error)
        asyncio.run(Estimates(estimator, METRICS).refuse_nobody(TASK))
        assert estimator.patient is False
