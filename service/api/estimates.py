"""The resources' access to the estimator: in separate threads, with its failures as problems."""

import time
from collections.abc import Callable, Mapping
from functools import partial
from typing import Final, TypeVar

from anyio import CapacityLimiter, to_thread

from api_schemas.checks import CaptureCheck
from api_schemas.initial_poses import InitialPose
from api_schemas.problems import problem
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
    Estimator,
    EstimatorFailedError,
    EstimatorTimeoutError,
    EstimatorUnavailableError,
    NoDetectorError,
    ProposedPoints,
)
from service.representation.formats import MeshFormat
from service.submissions.detector import DETECTOR_MISSING, NOT_INSTALLED, REMEDY
from service.submissions.refusal import RefusedError

SPARE_THREADS: Final = 4
"""Threads beyond what the estimator takes at a time: here, one too many is refused at once."""

SOON_S: Final = 2
"""When to ask an estimator again that is busy or starting."""

ESTIMATE_PROBLEMS: Final = (
    "malformed-request",
    "payload-too-large",
    "unsupported-media-type",
    "invalid-request",
    "unusable-input",
    "not-ready",
    "internal-error",
)
"""Problems with a question or with the estimator."""

OUTCOMES: Final[Mapping[type[Exception], str]] = {
    RefusedError: "refused",
    EstimatorUnavailableError: "unavailable",
    EstimatorTimeoutError: "timed_out",
    NoDetectorError: "unavailable",
}
"""How metrics label the outcome of a question; everything else is labelled failed."""

Answer = TypeVar("Answer")


class Estimates:
    """Questions to the estimator.

    They wait in threads that nothing else uses, so that however many there are, the rest of the API
    is not held up.
    """

    def __init__(self, estimator: Estimator, metrics: ServiceMetrics) -> None:
        self._estimator = estimator
        self._metrics = metrics
        self._threads = CapacityLimiter(estimator.capacity + SPARE_THREADS)

    async def body(self, task: BodyTask) -> EstimatedBody:
        """Estimate a body from measurements.

        Raises
        ------
        RefusedError
            If the question is at fault.
        ProblemError
            503 if there is no answer now, 500 if the question met a fault.
        """
        return await self._answer("body", partial(self._estimator.body, task))

    async def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        """Pose the mean person to match clicks; raises as :meth:`body` does."""
        return await self._answer("initial_pose", partial(self._estimator.initial_pose, task))

    async def points(self, task: PointsTask, image: bytes) -> ProposedPoints:
        """Propose the points of a person in an encoded picture; raises as :meth:`body` does.

        Also 404 where the detector is not installed.
        """
        try:
            return await self._answer("points", partial(self._estimator.points, task, image))
        except NoDetectorError as error:
            raise no_detector() from error

    async def check(self, task: CheckTask, image: bytes) -> CaptureCheck:
        """Say what is wrong with an encoded picture; raises as :meth:`points` does."""
        try:
            return await self._answer("check", partial(self._estimator.check, task, image))
        except NoDetectorError as error:
            raise no_detector() from error

    async def convert(self, glb: bytes, kind: MeshFormat) -> bytes:
        """Write the body of a GLB file in another format; raises as :meth:`body` does."""
        task = ConversionTask(ending=kind.ending)
        return await self._answer("conversion", partial(self._estimator.convert, task, glb))

    async def jpeg(self, image: bytes) -> bytes:
        """Write an encoded picture as a JPEG, upright; raises as :meth:`body` does."""
        return await self._answer("jpeg", partial(self._estimator.jpeg, image))

    async def refuse_nobody(self, task: BodyTask) -> None:
        """Raise :class:`service.submissions.refusal.RefusedError` if no body has what is known.

        If no estimator is ready nothing is checked, and the caller finds out later.
        """
        try:
            await self._in_thread(
                "known_person", partial(self._estimator.body, task, patient=False)
            )
        except (EstimatorUnavailableError, EstimatorFailedError):
            return

    async def _answer(self, name: str, question: Callable[[], Answer]) -> Answer:
        try:
            return await self._in_thread(name, question)
        except EstimatorUnavailableError as error:
            raise _not_now(
                code="estimator-unavailable",
                detail="All estimators are busy, or still starting.",
            ) from error
        except EstimatorTimeoutError as error:
            raise _not_now(
                code="estimator-timeout",
                detail="The estimate took too long and was given up.",
            ) from error
        except EstimatorFailedError as error:
            raise ProblemError(
                problem(
                    "internal-error",
                    code="estimator-failed",
                    detail="An unexpected fault ended the estimate; it has been logged.",
                    remedy="Report it; other requests are not affected.",
                )
            ) from error

    async def _in_thread(self, name: str, question: Callable[[], Answer]) -> Answer:
        started = time.monotonic()
        outcome = "answered"
        try:
            return await to_thread.run_sync(question, limiter=self._threads)
        except Exception as error:
            outcome = OUTCOMES.get(type(error), "failed")
            raise
        finally:
            self._metrics.count_estimate(
                question=name, outcome=outcome, seconds=time.monotonic() - started
            )


def no_detector() -> ProblemError:
    """Say that there is no detector here, and how to change that."""
    return ProblemError(
        problem("not-found", code=DETECTOR_MISSING, detail=NOT_INSTALLED, remedy=REMEDY)
    )


def _not_now(*, code: str, detail: str) -> ProblemError:
    return ProblemError(
        problem(
            "not-ready",
            code=code,
            detail=detail,
            remedy="Try again after the time in Retry-After.",
        ),
        headers={"Retry-After": str(SOON_S)},
    )
