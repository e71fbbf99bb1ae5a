"""An estimator that shares its memory prepares in a child, whose memory ends with it."""

from service.estimates.answering import Answers
from service.estimates.main import prepare_here
from service.process.apart import succeeds_apart
from service.settings import Settings


def prepare_apart(module: Answers, settings: Settings) -> None:
    """Prepare in a child; what that has compiled is read from its cache when it is called.

    Models and detector are there already, shared with whoever forked this process. The questions
    by which an estimator prepares write to many of their pages, each of which is a copy from then.
    """
    if not succeeds_apart(lambda: prepare_here(module, settings)):
        # What went wrong there is told here.
        prepare_here(module, settings)
