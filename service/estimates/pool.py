"""The API's estimator: a few processes, and a short queue before them."""

import queue
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Final

from api_schemas.initial_poses import InitialPose
from service.estimates.messages import (
    ANSWERS,
    Answer,
    BodyAnswer,
    BodyTask,
    InitialPoseAnswer,
    InitialPoseTask,
    RefusalAnswer,
)
from service.estimates.port import (
    EstimatedBody,
    EstimatorFailedError,
    EstimatorUnavailableError,
)
from service.estimates.process import EstimatorProcess
from service.refusal import refused

MOST_WAITING: Final = 20
"""Questions a process may have waiting: some two seconds' worth. More are told to come back."""


class EstimatorPool:
    """See :class:`service.estimates.port.Estimator`."""

    def __init__(
        self, command: Sequence[str], *, environment: Mapping[str, str], processes: int
    ) -> None:
        self._idle: queue.SimpleQueue[EstimatorProcess] = queue.SimpleQueue()
        self._processes = [
            EstimatorProcess(command, environment=environment) for _ in range(processes)
        ]
        for process in self._processes:
            self._idle.put(process)
        self._places = threading.BoundedSemaphore(processes * (1 + MOST_WAITING))

    def body(self, task: BodyTask) -> EstimatedBody:
        """Estimate a body from measurements."""
        answer, file = self._ask(task)
        if not isinstance(answer, BodyAnswer):
            raise EstimatorFailedError
        return EstimatedBody(estimate=answer.estimate, glb=file)

    def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        """Pose the mean person by clicks."""
        answer, _ = self._ask(task)
        if not isinstance(answer, InitialPoseAnswer):
            raise EstimatorFailedError
        return answer.pose

    def stop(self) -> None:
        """End the processes; questions that are being answered fail."""
        for process in self._processes:
            process.stop()

    def _ask(self, task: BodyTask | InitialPoseTask) -> tuple[Answer, bytes]:
        with self._process() as process:
            raw = process.ask(task.model_dump_json().encode())
        answer = ANSWERS.validate_json(raw.text)
        if isinstance(answer, RefusalAnswer):
            raise refused(answer.error, slug="unusable-input")
        return answer, raw.file

    @contextmanager
    def _process(self) -> Iterator[EstimatorProcess]:
        if not self._places.acquire(blocking=False):
            raise EstimatorUnavailableError
        try:
            process = self._idle.get()
            try:
                yield process
            finally:
                self._idle.put(process)
        finally:
            self._places.release()
