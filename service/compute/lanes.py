"""Lanes: questions that are answered within seconds, by children that are kept ready.

One answers the API's questions in the process that owns the fork server of jobs, asked over a
socket; the other reads headers of pictures for the API's process, which holds secrets and decodes
nothing.

Each child answers one question at a time. One that dies over a question, or takes too long, fails
that question alone and is replaced. All troubles are answers too, as problems.
"""

import logging
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from multiprocessing.connection import Client, Connection, Listener
from pathlib import Path
from typing import Final

from pydantic import ValidationError

from api_schemas.base import WireModel
from api_schemas.problems import Problem, problem
from service.compute.fork_server import Child, ForkServer, NoProcessError
from service.compute.messages import (
    DoneMessage,
    FaultMessage,
    ProblemMessage,
    ProgressMessage,
    Received,
    TaskMessage,
    receive,
    send,
)
from service.compute.tasks import ChildSetup, Parts, child_setup
from service.compute.turns import Turns
from service.process.logs import log_context
from service.process.supervisor import SAFE_PATH_VARIABLE
from service.settings import Settings
from service.submissions.image_header import DamagedImageError, ImageHeader, ReadHeader, kind_of
from service.submissions.refusal import RefusedError

LOG: Final = logging.getLogger(__name__)

MOST_WAITING: Final = 20
"""Questions that may wait per child: about two seconds' worth. More are told to come back."""

READY_WITHIN_S: Final = 5.0
"""Wait of a question for a child that is being started, as while the server loads."""

ANSWER_WITHIN_S: Final = 10.0
"""A hundred times what an answer takes: a child that needs more is stuck, and is replaced."""

EXIT_S: Final = 1.0
"""Wait for the exit code of a child that has closed its pipe."""

SOCKET: Final = "questions"
LOOK_S: Final = 0.02
BACKLOG: Final = 128

GIVEN_UP_S: Final = READY_WITHIN_S + (1 + MOST_WAITING) * ANSWER_WITHIN_S
"""By then an owner that runs has answered, however long those took that were before."""

COME_BACK: Final = "Try again after the time in Retry-After."

UNAVAILABLE: Final = problem(
    "not-ready",
    code="estimator-unavailable",
    detail="All estimators are busy, or still starting.",
    remedy=COME_BACK,
)
TIMED_OUT: Final = problem(
    "not-ready",
    code="estimator-timeout",
    detail="The estimate took too long and was given up.",
    remedy=COME_BACK,
)
FAILED: Final = problem(
    "internal-error",
    code="estimator-failed",
    detail="An unexpected fault ended the estimate; it has been logged.",
    remedy="Report it; other requests are not affected.",
)


def capacity(children: int) -> int:
    """Questions that are accepted at a time, being answered or waiting."""
    return children * (1 + MOST_WAITING)


class QuickLane:
    """Answers questions of owners who take turns; for any number of threads."""

    def __init__(
        self,
        server: ForkServer,
        setup: ChildSetup,
        *,
        children: int,
        ready_within_s: float = READY_WITHIN_S,
    ) -> None:
        self._ready_within_s = ready_within_s
        self._idle = deque(_Place(server, setup) for _ in range(children))
        self._turns: Turns[Future[_Place | None]] = Turns(capacity(children))
        self._lock = threading.Lock()

    def answer(self, question: TaskMessage, parts: Parts) -> Received:
        """Return what a child answers, or the problem why none does."""
        turn: Future[_Place | None] = Future()
        with self._lock:
            if (refused := self._turns.join(question.owner, turn)) is not None:
                refused.set_result(None)
            self._begin()
        place = turn.result()
        if place is None:
            return _told(UNAVAILABLE)
        began = time.monotonic()
        try:
            return place.answer(question, parts, ready_within_s=self._ready_within_s)
        finally:
            with self._lock:
                self._idle.append(place)
                self._turns.end(question.owner, time.monotonic() - began)
                self._begin()

    def _begin(self) -> None:
        while self._idle and (turn := self._turns.begin()) is not None:
            turn.set_result(self._idle.popleft())


class _Place:
    """A place where one question is answered at a time; not thread-safe."""

    def __init__(self, server: ForkServer, setup: ChildSetup) -> None:
        self._server = server
        self._setup = setup
        self._child: Child | None = None

    def answer(self, question: TaskMessage, parts: Parts, *, ready_within_s: float) -> Received:
        try:
            child = self._ready(ready_within_s)
        except NoProcessError as error:
            LOG.error("No process that answers can be forked (%s).", error)
            return _told(UNAVAILABLE)
        if child is None:
            return _told(UNAVAILABLE)
        deadline = time.monotonic() + ANSWER_WITHIN_S
        try:
            with child.killed_in_time(ANSWER_WITHIN_S):
                child.give(question, parts.values())
                answer = _final(child)
        except (EOFError, OSError, ValidationError):
            return _told(self._end(child, timed_out=time.monotonic() >= deadline))
        return _told(FAILED) if isinstance(answer.message, FaultMessage) else answer

    def _ready(self, within_s: float) -> Child | None:
        """The child, or another where it has died; None while the server is loading."""
        if self._child is not None and not self._child.is_waiting():
            LOG.error("An estimator died; starting another.")
            self._child.end()
            self._child = None
        if self._child is None and self._server.is_able(within_s):
            self._child = self._server.start_child(self._setup)
        return self._child

    def _end(self, child: Child, *, timed_out: bool) -> Problem:
        code = child.exit_code(EXIT_S)
        child.end()
        self._child = None
        if timed_out:
            LOG.error("An estimator did not answer within %.0f s.", ANSWER_WITHIN_S)
            return TIMED_OUT
        LOG.error("An estimator died over a question, exit code %s.", code)
        return FAILED


def _final(child: Child) -> Received:
    while True:
        received = child.receive()
        assert received is not None
        if not isinstance(received.message, ProgressMessage):
            return received


def _told(reason: Problem) -> Received:
    return Received(ProblemMessage(problem=reason), {})


Ask = Callable[[TaskMessage, Parts], Received]
"""Ask a question with its parts; whatever goes wrong is answered with a problem."""


def answer_questions(lane: QuickLane, address: str) -> None:
    """Answer whoever asks at this address, in threads, for as long as this process runs."""
    # Of an owner before this one, which was killed.
    Path(address).unlink(missing_ok=True)
    listener = Listener(address, family="AF_UNIX", backlog=BACKLOG)

    def listen() -> None:
        while True:
            try:
                connection = listener.accept()
            except OSError as error:
                LOG.error("A question could not be taken (%s).", error)
                time.sleep(LOOK_S)
                continue
            threading.Thread(target=_answer, args=(lane, connection), daemon=True).start()

    threading.Thread(target=listen, name="questions", daemon=True).start()


def _answer(lane: QuickLane, connection: Connection) -> None:
    with connection:
        try:
            asked = receive(connection)
            assert isinstance(asked.message, TaskMessage)
            with log_context(**asked.message.log_context):
                answer = lane.answer(asked.message, asked.parts)
            send(connection, answer.message, answer.parts.values())
        except (EOFError, OSError, ValidationError) as error:
            LOG.warning("A question was given up (%s).", type(error).__name__)


def asking(address: str) -> Ask:
    """Ask at this address, where an owner answers or soon does."""

    def ask(question: TaskMessage, parts: Parts) -> Received:
        deadline = time.monotonic() + READY_WITHIN_S
        while True:
            try:
                with Client(address, family="AF_UNIX") as connection:
                    send(connection, question, parts.values())
                    if connection.poll(GIVEN_UP_S):
                        return receive(connection)
                return Received(ProblemMessage(problem=TIMED_OUT), {})
            except (EOFError, OSError):
                # The owner is starting, or has just ended: questions change nothing, and are asked
                # again.
                if time.monotonic() >= deadline:
                    return Received(ProblemMessage(problem=UNAVAILABLE), {})
                time.sleep(LOOK_S)

    return ask


HEADERS: Final = "service.compute.headers"

HEADER_CHILDREN: Final = 2
"""A header takes some milliseconds; more requests wait than the API has threads."""

HEADERS_READY_WITHIN_S: Final = 60.0
"""Wait of a picture for a child: they load in a second or two, and on a busy machine in
more. The API takes requests meanwhile."""

HEADER: Final = "header"
PICTURE: Final = "picture"
ANSWER: Final = "answer"


class HeaderAnswer(WireModel):
    """The header, or how the picture is damaged."""

    header: ImageHeader | None = None
    damage: str = ""


def header_lane(settings: Settings) -> Callable[[str], ReadHeader]:
    """Start the children, and return what has a header read by one of them for an owner.

    It raises :class:`RefusedError` too, where none of them answers in time.
    """
    os.environ[SAFE_PATH_VARIABLE] = "1"
    server = ForkServer(HEADERS)
    server.begin_preloading()
    setup = child_setup(settings, name="header", tasks=HEADERS)
    lane = QuickLane(server, setup, children=HEADER_CHILDREN, ready_within_s=HEADERS_READY_WITHIN_S)

    def ask(owner: str, content: bytes) -> Received:
        task = TaskMessage(task=HEADER, owner=owner, parts=(PICTURE,))
        return lane.answer(task, {PICTURE: content})

    def read(owner: str, content: bytes) -> ImageHeader:
        # What can be told from the first bytes needs no child.
        kind_of(content)
        answer = ask(owner, content)
        if _problem_in(answer) == FAILED:
            # Something else may have killed the child: only a second one tells of the picture.
            answer = ask(owner, content)
        if isinstance(answer.message, DoneMessage):
            said = HeaderAnswer.model_validate_json(answer.parts[ANSWER])
            if said.header is not None:
                return said.header
            raise DamagedImageError(said.damage)
        if (told := _problem_in(answer)) in (UNAVAILABLE, TIMED_OUT):
            raise RefusedError(told)
        message = "its header cannot be read"
        raise DamagedImageError(message)

    return lambda owner: partial(read, owner)


def _problem_in(answer: Received) -> Problem | None:
    return answer.message.problem if isinstance(answer.message, ProblemMessage) else None
