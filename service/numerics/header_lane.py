"""Headers of pictures, read in children: the API's process holds secrets and decodes nothing."""

import os
from typing import Final

from api_schemas.base import WireModel
from api_schemas.problems import Problem
from service.numerics.fork_server import ForkServer
from service.numerics.messages import DoneMessage, ProblemMessage, Received, TaskMessage
from service.numerics.quick_lane import FAILED, TIMED_OUT, UNAVAILABLE, QuickLane
from service.numerics.tasks import child_setup
from service.process.supervisor import SAFE_PATH_VARIABLE
from service.settings import Settings
from service.submissions.image_header import DamagedImageError, ImageHeader, ReadHeader, kind_of
from service.submissions.refusal import RefusedError

SECRETLESS: Final = "service.compute.secretless"
PRELOAD: Final = "service.numerics.preload"
CHILD: Final = "service.numerics.header_child"

CHILDREN: Final = 2
"""A header takes some milliseconds; more requests wait than the API has threads."""

READY_WITHIN_S: Final = 60.0
"""How long a picture waits for a child: they load in a second or two, and on a busy machine in
more. The API takes requests meanwhile."""

HEADER: Final = "header"
PICTURE: Final = "picture"
ANSWER: Final = "answer"


class HeaderAnswer(WireModel):
    """The header, or how the picture is damaged."""

    header: ImageHeader | None = None
    damage: str = ""


def header_lane(settings: Settings) -> ReadHeader:
    """Start the children, and return what has a header read by one of them.

    It raises :class:`RefusedError` too, where none of them answers in time.
    """
    os.environ[SAFE_PATH_VARIABLE] = "1"
    server = ForkServer(SECRETLESS, PRELOAD)
    server.begin_preloading()
    setup = child_setup(settings, name="header", tasks=CHILD)
    lane = QuickLane(server, setup, children=CHILDREN, ready_within_s=READY_WITHIN_S)

    def ask(content: bytes) -> Received:
        return lane.answer(TaskMessage(task=HEADER, parts=(PICTURE,)), {PICTURE: content})

    def read(content: bytes) -> ImageHeader:
        # What can be told from the first bytes needs no child.
        kind_of(content)
        answer = ask(content)
        if _told(answer) == FAILED:
            # Something else may have killed the child: only a second one tells of the picture.
            answer = ask(content)
        if isinstance(answer.message, DoneMessage):
            said = HeaderAnswer.model_validate_json(answer.parts[ANSWER])
            if said.header is not None:
                return said.header
            raise DamagedImageError(said.damage)
        if (told := _told(answer)) in (UNAVAILABLE, TIMED_OUT):
            raise RefusedError(told)
        message = "its header cannot be read"
        raise DamagedImageError(message)

    return read


def _told(answer: Received) -> Problem | None:
    return answer.message.problem if isinstance(answer.message, ProblemMessage) else None
