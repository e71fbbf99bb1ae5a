"""How an API asks the quick lane of the process beside it: over a socket in a folder of its own.

Each question has a connection of its own, over which it goes as it is answered: the owner of the
children queues, times and replaces them. The folder lies where only the API's user may enter, and
where no child may write, which could put a socket of its own in the place of this one.
"""

import logging
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Client, Connection, Listener
from pathlib import Path
from typing import Final

from pydantic import ValidationError

from service.numerics.messages import ProblemMessage, Received, TaskMessage, receive, send
from service.numerics.quick_lane import (
    ANSWER_WITHIN_S,
    MOST_WAITING,
    READY_WITHIN_S,
    TIMED_OUT,
    UNAVAILABLE,
    QuickLane,
)
from service.numerics.tasks import Parts
from service.process.logs import log_context

LOG: Final = logging.getLogger(__name__)

SOCKET: Final = "questions"
LOOK_S: Final = 0.02
BACKLOG: Final = 128

GIVEN_UP_S: Final = READY_WITHIN_S + (1 + MOST_WAITING) * ANSWER_WITHIN_S
"""By then an owner that runs has answered, however long those took that were before."""

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
        deadline = time.monotonic() + (READY_WITHIN_S if question.patient else 0.0)
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
