"""The estimator process: the body models in memory, a question in, an answer out."""

import logging
import os
import resource
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Final

from fitter.errors import ModelFileError
from service.estimates.answering import Answers, load_answers
from service.estimates.messages import (
    READY,
    TASKS,
    Answer,
    BodyAnswer,
    BodyTask,
    CheckAnswer,
    CheckTask,
    ConversionAnswer,
    ConversionTask,
    FaultAnswer,
    InitialPoseAnswer,
    JpegAnswer,
    JpegTask,
    NoDetectorAnswer,
    PointsAnswer,
    PointsTask,
    RefusalAnswer,
)
from service.estimates.port import NoDetectorError
from service.process.child_work import succeeds_in_child
from service.process.heap import give_back
from service.settings import Settings
from service.worker.main import THREAD_LIMITS
from service.worker.models_reading import unusable_models
from service.worker.pipeline_port import UnusableInputError

LOG: Final = logging.getLogger(__name__)

ANSWERS_MODULE: Final = "service.estimates.answers"
SANDBOX_ANSWERS: Final = "service.estimates.sandbox_answers"


Prepare = Callable[[Answers, Settings], None]


def prepare_here(module: Answers, settings: Settings) -> None:
    """Load and compile whatever takes long the first time.

    Raises
    ------
    SettingError
        If the body models cannot be used.
    """
    try:
        module.prepare(settings.models_dir, settings.detector_dir)
    except ModelFileError as error:
        raise unusable_models(settings, str(error)) from error


def prepare_in_child(module: Answers, settings: Settings) -> None:
    """Prepare in a child; what that has compiled is read from its cache when it is called.

    For an estimator that shares models and detector with whoever forked it. The questions by which
    it prepares write to many of their pages, each of which is a copy from then on.
    """
    if not succeeds_in_child(lambda: prepare_here(module, settings)):
        # What went wrong there is told here.
        prepare_here(module, settings)


def run_estimator(
    settings: Settings,
    connection: Connection,
    *,
    answers: str | None = None,
    prepare: Prepare = prepare_here,
) -> None:
    """Answer until the connection ends.

    ``answers`` are by default the real ones, or the sandbox's where that is set; ``prepare``
    makes them ready.
    """
    if answers is None:
        answers = SANDBOX_ANSWERS if settings.sandbox else ANSWERS_MODULE
    for variable in THREAD_LIMITS:
        os.environ.setdefault(variable, "1")
    limit = settings.child_memory_mb * 1024 * 1024
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        connection.send_bytes(str(os.getpid()).encode())
        module = load_answers(answers)
        prepare(module, settings)
        give_back()
        connection.send_bytes(READY)
        while True:
            question, brought = connection.recv_bytes(), connection.recv_bytes()
            answer, file = _answer(module, question, brought, settings)
            connection.send_bytes(answer.model_dump_json().encode())
            connection.send_bytes(file)
            # A picture takes a hundred times what is needed between questions.
            give_back()
    except (EOFError, OSError):
        # The API is gone.
        return


def _answer(
    module: Answers, text: bytes, brought: bytes, settings: Settings
) -> tuple[Answer, bytes]:
    try:
        task = TASKS.validate_json(text)
        if isinstance(task, BodyTask):
            body = module.body(task, settings.models_dir)
            return BodyAnswer(estimate=body.estimate), body.glb
        if isinstance(task, ConversionTask):
            return ConversionAnswer(), module.conversion(task, brought)
        if isinstance(task, PointsTask):
            proposed = module.points(
                task,
                brought,
                max_pixels=settings.max_pixels,
                detector=settings.detector_dir,
            )
            return PointsAnswer(proposal=proposed.proposal), proposed.mask
        if isinstance(task, CheckTask):
            check = module.check(
                task,
                brought,
                max_pixels=settings.max_pixels,
                detector=settings.detector_dir,
            )
            return CheckAnswer(check=check), b""
        if isinstance(task, JpegTask):
            return JpegAnswer(), module.jpeg(brought, max_pixels=settings.max_pixels)
        return InitialPoseAnswer(pose=module.initial_pose(task, settings.models_dir)), b""
    except UnusableInputError as error:
        return RefusalAnswer(error=error.error), b""
    except NoDetectorError:
        return NoDetectorAnswer(), b""
    except Exception:
        LOG.exception("An estimate failed.")
        return FaultAnswer(), b""
