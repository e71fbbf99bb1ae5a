"""Headers of pictures, read in children: the API's process holds secrets and decodes nothing."""

import os
from typing import Final

from api_schemas.base import WireModel
from service.numerics.fork_server import ForkServer
from service.numerics.messages import DoneMessage, ProblemMessage, TaskMessage
from service.numerics.quick_lane import UNAVAILABLE, QuickLane
from service.numerics.tasks import child_setup
from service.process.supervisor import SAFE_PATH_VARIABLE
from service.settings import Settings
from service.submissions.image_header import DamagedImageError, ImageHeader, ReadHeader, kind_of
from service.submissions.refusal import RefusedError

SECRETLESS: Final = "service.worker.secretless"
PRELOAD: Final = "service.numerics.preload"
CHILD: Final = "service.numerics.header_child"

CHILDREN: Final = 2
"""A header takes some milliseconds; more requests wait than the API has threads."""

HEADER: Final = "header"
PICTURE: Final = "picture"
ANSWER: Final = "answer"


class HeaderAnswer(WireModel):
    """The header, or how the picture is damaged."""

    header: ImageHeader | None = None
    damage: str = ""


def header_lane(settings: Settings) -> ReadHeader:
    """Start the children, and return what has a header read by one of them.

    It raises :class:`RefusedError` too, while they are starting.
    """
    os.environ[SAFE_PATH_VARIABLE] = "1"
    server = ForkServer(SECRETLESS, PRELOAD)
    server.begin_preloading()
    lane = QuickLane(server, child_setup(settings, name="header", tasks=CHILD), children=CHILDREN)

    def read(content: bytes) -> ImageHeader:
        # What can be told from the first bytes needs no child.
        kind_of(content)
        answer = lane.answer(TaskMessage(task=HEADER, parts=(PICTURE,)), {PICTURE: content})
        if isinstance(answer.message, DoneMessage):
            said = HeaderAnswer.model_validate_json(answer.parts[ANSWER])
            if said.header is not None:
                return said.header
            raise DamagedImageError(said.damage)
        if isinstance(answer.message, ProblemMessage) and answer.message.problem == UNAVAILABLE:
            raise RefusedError(UNAVAILABLE)
        message = "its header cannot be read"
        raise DamagedImageError(message)

    return read
