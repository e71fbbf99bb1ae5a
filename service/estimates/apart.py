"""An estimator that shares its memory prepares in a child, whose memory ends with it."""

import os

from service.estimates.answering import Answers
from service.estimates.main import prepare_here
from service.settings import Settings
from service.worker.compiled_kernels import load_compiled_kernels


def prepare_apart(module: Answers, settings: Settings) -> None:
    """Prepare in a child; then read what that has compiled.

    Models and detector are there already, shared with whoever forked this process. The questions
    by which an estimator prepares write to many of their pages, each of which is a copy from then.
    """
    child = os.fork()
    if child == 0:
        _prepare_and_end(module, settings)
    _, status = os.waitpid(child, 0)
    if status != 0:
        # What went wrong there is told here.
        prepare_here(module, settings)
    load_compiled_kernels()


def _prepare_and_end(module: Answers, settings: Settings) -> None:
    status = os.EX_SOFTWARE
    try:
        prepare_here(module, settings)
        status = os.EX_OK
    finally:
        os._exit(status)
