"""The API's estimator: a few processes behind a short queue."""

import queue
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from api_schemas.checks import CaptureCheck
from api_schemas.initial_poses import InitialPose
from service.estimates.messages import (
    ANSWERS,
    Answer,
    BodyAnswer,
    BodyTask,
    CheckAnswer,
    CheckTask,
    ConversionAnswer,
    ConversionTask,
    InitialPoseAnswer,
    InitialPoseTask,
    JpegAnswer,
    JpegTask,
    NoDetectorAnswer,
    PointsAnswer,
    PointsTask,
    RefusalAnswer,
    Task,
)
from service.estimates.port import (
    EstimatedBody,
    EstimatorFailedError,
    EstimatorUnavailableError,
    NoDetectorError,
    ProposedPoints,
)
from service.estimates.process import EstimatorProcess
from service.estimates.starting import Start
from service.submissions.refusal import refused

MOST_WAITING: Final = 20
"""Questions that may wait per process: about two seconds' worth. More are told to come back."""

MOMENT_S: Final = 0.5
"""How long a question waits for a busy process if it can do without an answer."""

LOOK_AFTER_S: Final = 5.0
"""How often idle processes are checked, so that one that died is back before the next question."""


class EstimatorPool:
    """See :class:`service.estimates.port.Estimator`."""

    def __init__(self, start: Start, *, processes: int) -> None:
        self._idle: queue.SimpleQueue[EstimatorProcess] = queue.SimpleQueue()
        self._processes = [EstimatorProcess(start) for _ in range(processes)]
        for process in self._processes:
            self._idle.put(process)
        self._capacity = processes * (1 + MOST_WAITING)
        self._places = threading.BoundedSemaphore(self._capacity)
        self._stopping = threading.Event()
        self._watch = threading.Thread(target=self._look_after, name="estimators", daemon=True)
        self._watch.start()

    @property
    def capacity(self) -> int:
        """How many questions are accepted at a time."""
        return self._capacity

    def body(self, task: BodyTask, *, patient: bool = True) -> EstimatedBody:
        """Estimate a body from measurements."""
        answer, file = self._ask(task, patient=patient)
        if not isinstance(answer, BodyAnswer):
            raise EstimatorFailedError
        return EstimatedBody(estimate=answer.estimate, glb=file)

    def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        """Pose the mean person to match clicks."""
        answer, _ = self._ask(task, patient=True)
        if not isinstance(answer, InitialPoseAnswer):
            raise EstimatorFailedError
        return answer.pose

    def points(self, task: PointsTask, image: bytes) -> ProposedPoints:
        """Propose the points of a person in an encoded picture."""
        answer, file = self._ask(task, brought=image, patient=True)
        if isinstance(answer, NoDetectorAnswer):
            raise NoDetectorError
        if not isinstance(answer, PointsAnswer):
            raise EstimatorFailedError
        return ProposedPoints(proposal=answer.proposal, mask=file)

    def check(self, task: CheckTask, image: bytes) -> CaptureCheck:
        """Say what is wrong with an encoded picture."""
        answer, _ = self._ask(task, brought=image, patient=True)
        if isinstance(answer, NoDetectorAnswer):
            raise NoDetectorError
        if not isinstance(answer, CheckAnswer):
            raise EstimatorFailedError
        return answer.check

    def convert(self, task: ConversionTask, glb: bytes) -> bytes:
        """Write the body of a GLB file in another format."""
        answer, file = self._ask(task, brought=glb, patient=True)
        if not isinstance(answer, ConversionAnswer):
            raise EstimatorFailedError
        return file

    def jpeg(self, image: bytes) -> bytes:
        """Write an encoded picture as a JPEG, upright."""
        answer, file = self._ask(JpegTask(), brought=image, patient=True)
        if not isinstance(answer, JpegAnswer):
            raise EstimatorFailedError
        return file

    def stop(self) -> None:
        """End the processes; pending questions fail."""
        self._stopping.set()
        self._watch.join()
        for process in self._processes:
            process.stop()

    def _ask(self, task: Task, *, patient: bool, brought: bytes = b"") -> tuple[Answer, bytes]:
        with self._process(timeout_s=None if patient else MOMENT_S) as process:
            raw = process.ask(task.model_dump_json().encode(), brought, patient=patient)
        answer = ANSWERS.validate_json(raw.text)
        if isinstance(answer, RefusalAnswer):
            raise refused(answer.error, slug="unusable-input")
        return answer, raw.file

    @contextmanager
    def _process(self, *, timeout_s: float | None) -> Iterator[EstimatorProcess]:
        if not self._places.acquire(blocking=False):
            raise EstimatorUnavailableError
        try:
            try:
                process = self._idle.get(timeout=timeout_s)
            except queue.Empty as error:
                raise EstimatorUnavailableError from error
            try:
                yield process
            finally:
                self._idle.put(process)
        finally:
            self._places.release()

    def _look_after(self) -> None:
        while not self._stopping.wait(LOOK_AFTER_S):
            for _ in self._processes:
                try:
                    process = self._idle.get_nowait()
                except queue.Empty:
                    break
                try:
                    process.revive()
                finally:
                    self._idle.put(process)
