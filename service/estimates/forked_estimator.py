"""An estimator forked by the worker beside its API (:mod:`service.worker.fork_requests`)."""

from multiprocessing.connection import Connection

# Imported by the fork server, so that it is there, and shared, in what is forked.
from service.estimates import answers as answers
from service.estimates.main import prepare_in_child, run_estimator
from service.process.naming import call_process
from service.startup.begin import begin, run_told


def answer(connection: Connection) -> None:
    """Answer until the connection ends."""
    call_process("estimator")
    settings = begin("estimator")
    run_told("estimator", lambda: run_estimator(settings, connection, prepare=prepare_in_child))
