"""What the API makes of an estimator's answers and troubles."""

import asyncio

import pytest

from api_schemas.bodies import BodyRequest
from api_schemas.initial_poses import InitialPose
from api_schemas.problems import FieldProblem
from api_schemas.requests import Gender
from service.api.estimates import Estimates
from service.api.figures import Figures
from service.api.problems import ProblemError
from service.estimates.messages import BodyTask, InitialPoseTask
from service.estimates.port import (
    EstimatedBody,
    EstimatorFailedError,
    EstimatorTimeoutError,
    EstimatorUnavailableError,
)
from service.refusal import RefusedError, refused

TASK = BodyTask(request=BodyRequest(gender=Gender.MALE), with_glb=False)
NOBODY = refused(
    FieldProblem(field="weight_kg", code="contradictory-measurements", reason="No.", remedy="Yes.")
)


class NoEngine:
    """No figures but those counted here are asked for."""


FIGURES = Figures(NoEngine())


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


@pytest.mark.parametrize(
    ("error", "status", "code", "retry"),
    [
        (EstimatorUnavailableError(), 503, "estimator-unavailable", True),
        (EstimatorTimeoutError(), 503, "estimator-timeout", True),
        (EstimatorFailedError(), 500, "estimator-failed", False),
    ],
)
def test_an_estimator_s_troubles_are_problems(error, status, code, retry):
    with pytest.raises(ProblemError) as caught:
        asyncio.run(Estimates(RaisingEstimator(error), FIGURES).body(TASK))
    assert (caught.value.problem.status, caught.value.problem.code) == (status, code)
    assert ("Retry-After" in caught.value.headers) is retry


def test_who_is_nobody_is_refused_and_other_troubles_are_left_to_the_job():
    with pytest.raises(RefusedError):
        asyncio.run(Estimates(RaisingEstimator(NOBODY), FIGURES).refuse_nobody(TASK))
    for error in (EstimatorUnavailableError(), EstimatorTimeoutError(), EstimatorFailedError()):
        estimator = RaisingEstimator(error)
        asyncio.run(Estimates(estimator, FIGURES).refuse_nobody(TASK))
        assert estimator.patient is False
