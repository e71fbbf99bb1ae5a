"""The resources' access to the estimators: in separate threads, with troubles as problems."""

import time
from collections.abc import Mapping
from functools import partial
from typing import Final, TypeVar

from anyio import CapacityLimiter, to_thread
from pydantic import BaseModel

from api_schemas.problems import Problem
from api_schemas.questions import BodyEstimate, InitialPose, PointsProposal, PointsRequest
from service.api.metrics import ServiceMetrics
from service.api.problems import ProblemError
from service.compute.lanes import FAILED, TIMED_OUT, UNAVAILABLE, Ask, capacity
from service.compute.messages import DoneMessage, ProblemMessage, TaskMessage
from service.compute.tasks import Parts
from service.estimates import questions
from service.estimates.questions import (
    ANSWER,
    FILE,
    QUESTION,
    BodyTask,
    ConversionTask,
    EstimatedBody,
    InitialPoseTask,
    ProposedPoints,
)
from service.process.logs import current_log_context
from service.representation.formats import MeshFormat
from service.submissions.refusal import RefusedError
from service.submissions.submission import DETECTOR_MISSING

SPARE_THREADS: Final = 4
"""Threads beyond what the estimators take at a time: there, one too many is refused at once."""

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

UNUSABLE: Final = 422

OUTCOMES: Final[Mapping[str, str]] = {
    UNAVAILABLE.code: "unavailable",
    DETECTOR_MISSING: "unavailable",
    TIMED_OUT.code: "timed_out",
    FAILED.code: "failed",
}
"""How metrics label the problem of a question; every other one is that the question is refused."""

Answer = TypeVar("Answer", bound=BaseModel)


class Estimates:
    """Questions to so many estimators.

    They wait in threads that nothing else uses, so that however many there are, the rest of the API
    is not held up.
    """

    def __init__(self, ask: Ask, metrics: ServiceMetrics, *, estimators: int) -> None:
        self._ask = ask
        self._metrics = metrics
        self._threads = CapacityLimiter(capacity(estimators) + SPARE_THREADS)

    async def body(self, task: BodyTask) -> EstimatedBody:
        """Estimate a body from measurements.

        Raises
        ------
        RefusedError
            If the question is at fault.
        ProblemError
            503 if there is no answer now, 500 if the question met a fault.
        """
        parts = await self._answer(questions.BODY, task)
        return EstimatedBody(estimate=_parsed(BodyEstimate, parts), glb=parts[FILE])

    async def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        """Pose the mean person to match clicks; raises as :meth:`body` does."""
        return _parsed(InitialPose, await self._answer(questions.INITIAL_POSE, task))

    async def points(self, asked: PointsRequest, image: bytes) -> ProposedPoints:
        """Propose the points of a person in an encoded picture, of whom known points are named.

        Raises as :meth:`body` does, and 404 where the detector is not installed.
        """
        parts = await self._answer(questions.POINTS, asked, image)
        return ProposedPoints(proposal=_parsed(PointsProposal, parts), mask=parts[FILE])

    async def convert(self, glb: bytes, kind: MeshFormat) -> bytes:
        """Write the body of a GLB file in another format; raises as :meth:`body` does."""
        task = ConversionTask(ending=kind.ending)
        return (await self._answer(questions.CONVERSION, task, glb))[FILE]

    async def jpeg(self, image: bytes) -> bytes:
        """Write an encoded picture as a JPEG, upright; raises as :meth:`body` does."""
        return (await self._answer(questions.JPEG, None, image))[FILE]

    async def refuse_nobody(self, task: BodyTask) -> None:
        """Raise :class:`service.submissions.refusal.RefusedError` if no body has what is known.

        If no estimator is ready nothing is checked, and the caller finds out later.
        """
        try:
            await self._answer(questions.BODY, task, patient=False, label="known_person")
        except ProblemError:
            return

    async def _answer(
        self,
        name: str,
        question: BaseModel | None,
        file: bytes = b"",
        *,
        patient: bool = True,
        label: str | None = None,
    ) -> Parts:
        asked = b"" if question is None else question.model_dump_json().encode()
        parts = {QUESTION: asked, FILE: file}
        task = TaskMessage(
            task=name,
            parts=tuple(parts),
            log_context=dict(current_log_context()),
            patient=patient,
        )
        started = time.monotonic()
        outcome = "failed"
        try:
            received = await to_thread.run_sync(
                partial(self._ask, task, parts), limiter=self._threads
            )
            match received.message:
                case DoneMessage():
                    outcome = "answered"
                    return received.parts
                case ProblemMessage(problem=reason):
                    outcome = OUTCOMES.get(reason.code, "refused")
                    raise _raised(reason)
                case _:
                    raise ProblemError(FAILED)
        finally:
            self._metrics.count_estimate(
                question=label or name, outcome=outcome, seconds=time.monotonic() - started
            )


def _parsed(kind: type[Answer], parts: Parts) -> Answer:
    return kind.model_validate_json(parts[ANSWER])


def _raised(reason: Problem) -> RefusedError | ProblemError:
    if reason.status == UNUSABLE:
        return RefusedError(reason)
    later = reason.code in (UNAVAILABLE.code, TIMED_OUT.code)
    return ProblemError(reason, headers={"Retry-After": str(SOON_S)} if later else {})
