"""In a child of the API: headers of pictures are read."""

from collections.abc import Mapping
from typing import Final

from PIL import Image

from fitter.observation.picture_files import decodes_heif, read_exif, ready_decoder
from service.compute.lanes import ANSWER, HEADER, PICTURE, HeaderAnswer
from service.compute.tasks import ChildSetup, Observe, Parts, Task
from service.submissions.image_header import DamagedImageError, read_image_header

LOADED: Final = (Image.init(), read_exif)
"""Loaded before the first fork, as every child needs it."""


def _header(_setup: ChildSetup, parts: Parts, _observe: Observe) -> Parts:
    try:
        answer = HeaderAnswer(header=read_image_header(parts[PICTURE]))
    except DamagedImageError as error:
        answer = HeaderAnswer(damage=str(error))
    return {ANSWER: answer.model_dump_json().encode()}


TASKS: Final[Mapping[str, Task]] = {HEADER: _header}

if decodes_heif():
    ready_decoder(PICTURE)
