"""An estimator with the fake answers, forked by a worker."""

from multiprocessing.connection import Connection

from service.estimates.main import prepare_in_child, run_estimator
from service.process.naming import call_process
from service.settings import Settings


def answer(connection: Connection) -> None:
    """Answer until the connection ends."""
    call_process("estimator")
    run_estimator(
        Settings(),
        connection,
        answers="tests.integration.service.fake_answers",
        prepare=prepare_in_child,
    )
