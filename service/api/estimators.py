"""The resources' access to the estimators: in separate threads, with troubles as problems."""

from copy import copy
from functools import partial
from typing import Final

from anyio import CapacityLimiter, to_thread
from pydantic import BaseModel

from api_schemas.problems import Problem
from service.api.problems import ProblemError
from service.compute import questions
from service.compute.lanes import FAILED, TIMED_OUT, UNAVAILABLE, Ask, capacity
from service.compute.messages import DoneMessage, ProblemMessage, TaskMessage
from service.compute.questions import FILE, QUESTION, ConversionTask
from service.compute.tasks import Parts
from service.process.logs import current_log_context
from service.submissions.refusal import RefusedError

SPARE_THREADS: Final = 4
"""Threads beyond what the estimators take at a time: there, one too many is refused at once."""

SOON_S: Final = 2
"""The pause before an estimator that is busy or starting is asked again."""

UNUSABLE: Final = 422


class Estimators:
    """Questions to so many estimators.

    They wait in threads that nothing else uses, so that however many there are, the rest of the API
    is not held up.
    """

    def __init__(self, ask: Ask, *, estimators: int) -> None:
        self._ask = ask
        self._threads = CapacityLimiter(capacity(estimators) + SPARE_THREADS)
        self._owner = ""

    def of(self, owner: str) -> "Estimators":
        """The same estimators, for the questions of an owner, who has turns of its own."""
        theirs = copy(self)
        theirs._owner = owner  # noqa: SLF001
        return theirs

    async def answer(
        self,
        name: str,
        question: BaseModel | None,
        file: bytes = b"",
    ) -> Parts:
        """Ask a question of :mod:`service.compute.questions`, and return the parts of the answer.

        Raises
        ------
        RefusedError
            If the question is at fault.
        ProblemError
            503 if there is no answer now, 404 if the detector it needs is not installed, 500 if the
            question met a fault.
        """
        asked = b"" if question is None else question.model_dump_json().encode()
        parts = {QUESTION: asked, FILE: file}
        task = TaskMessage(
            task=name,
            owner=self._owner,
            parts=tuple(parts),
            log_context=dict(current_log_context()),
        )
        received = await to_thread.run_sync(partial(self._ask, task, parts), limiter=self._threads)
        match received.message:
            case DoneMessage():
                return received.parts
            case ProblemMessage(problem=reason):
                raise _raised(reason)
            case _:
                raise ProblemError(FAILED)

    async def convert(self, glb: bytes, ending: str) -> bytes:
        """Write the body of a GLB file in the format of an ending; raises as :meth:`answer`."""
        task = ConversionTask(ending=ending)
        return (await self.answer(questions.CONVERSION, task, glb))[FILE]

    async def jpeg(self, image: bytes) -> bytes:
        """Write an encoded picture as a JPEG, upright; raises as :meth:`answer` does."""
        return (await self.answer(questions.JPEG, None, image))[FILE]


def _raised(reason: Problem) -> RefusedError | ProblemError:
    if reason.status == UNUSABLE:
        return RefusedError(reason)
    later = reason.code in (UNAVAILABLE.code, TIMED_OUT.code)
    return ProblemError(reason, headers={"Retry-After": str(SOON_S)} if later else {})
