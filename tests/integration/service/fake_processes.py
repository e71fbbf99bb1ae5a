"""The service's processes with the fake pipeline: ``serve``, ``worker`` or ``estimators``.

``serve`` with ``--no-worker`` leaves its workers to the test. Estimators answer what they are told
(``fake``), end as soon as they are started (``broken``), or are the ``real`` ones.
"""

import argparse
import os
import signal
import sys
import threading
from pathlib import Path

NAME = "tests.integration.service.fake_processes"
FAKE = "tests.integration.service.fake_pipeline"
ESTIMATES = {"fake": "tests.integration.service.fake_answers", "real": "service.compute.answers"}
FAKE_PRELOAD = "tests.integration.service.fake_preload"
REAL_PRELOAD = "service.compute.preload"


def command(*arguments: str) -> tuple[str, ...]:
    """The command that starts one."""
    return (sys.executable, "-m", NAME, *arguments)


# What is imported within functions is so because every forked child imports this module again, and
# is to start quickly.


def serve(*arguments: str) -> None:
    from service.commands.serve import serve as serve_with
    from service.process.listener import listen
    from service.process.logs import configure_logging
    from service.settings import Settings

    parser = argparse.ArgumentParser()
    parser.add_argument("--no-worker", action="store_true")
    parser.add_argument("--estimator", choices=("fake", "broken", "real"), default="fake")
    parser.add_argument("--data-dir", type=Path)
    parsed = parser.parse_args(arguments)
    given = {} if parsed.data_dir is None else {"data_dir": parsed.data_dir, "port": 0}
    settings = Settings(**given)
    configure_logging(settings.log_level, settings.log_format)
    serve_with(
        settings,
        listen(settings),
        worker_command=None if parsed.no_worker else command("worker", parsed.estimator),
        estimators_command=command("estimators", parsed.estimator),
        announce=lambda text: print(text, flush=True),
    )


def worker(estimates: str = "broken", questions_at: str | None = None) -> None:
    """Work until whoever started it ends or says so, unlike ``maquette worker``.

    Beside an API it is told what its estimators are, and the address of the API's questions.
    """
    from service.compute.worker import run_worker
    from service.process.logs import configure_logging
    from service.settings import Settings
    from tests.integration.service.fake_pipeline import describe

    # The processes that a worker starts look for nothing in the current folder.
    os.environ["PYTHONPATH"] = str(Path(__file__).parents[3])
    threading.Thread(target=stop_with_starter, daemon=True).start()
    settings = Settings()
    configure_logging(settings.log_level, settings.log_format)
    run_worker(
        settings,
        questions_at=questions_at if estimates in ESTIMATES else None,
        pipeline=FAKE,
        estimates=ESTIMATES.get(estimates),
        # Real answers have ten seconds: not enough to compile their kernels.
        preload=REAL_PRELOAD if estimates == "real" else FAKE_PRELOAD,
        read_models=describe,
    )


def estimators(estimates: str, questions_at: str) -> None:
    from service.compute.worker import run_estimators
    from service.process.logs import configure_logging
    from service.settings import Settings

    os.environ["PYTHONPATH"] = str(Path(__file__).parents[3])
    settings = Settings()
    configure_logging(settings.log_level, settings.log_format)
    run_estimators(
        settings,
        questions_at=questions_at,
        estimates=ESTIMATES[estimates],
        preload=FAKE_PRELOAD,
    )


def stop_with_starter() -> None:
    while os.read(sys.stdin.fileno(), 1_024):
        pass
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == "__main__":
    {"serve": serve, "worker": worker, "estimators": estimators}[sys.argv[1]](*sys.argv[2:])
