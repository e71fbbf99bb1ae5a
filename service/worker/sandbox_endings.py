"""How a sandbox lets a job end as its caller asked for."""

import os
import signal
import time
from collections.abc import Callable, Sequence
from typing import Final, NoReturn

from api_schemas.problems import FieldProblem
from api_schemas.results import FitResult, FitWarning
from fitter.vocabulary.outcomes import Outcome
from service.blobs import BlobsUnavailableError, StorageFullError
from service.engine.port import Report
from service.jobs.sandbox import (
    BY_ACCIDENT,
    OF_A_VIEW,
    UNUSABLE_FOR_DERIVATIONS,
    UNUSABLE_PICTURES,
    VERDICTS,
    WARNINGS,
    slowness_s,
)
from service.numerics.tasks import ProblemError
from service.settings import Settings
from service.worker.endings import input_gone, no_process, no_storage, too_slow
from service.worker.pipeline_port import AnyFitResult, UnusableInputError

_ASKED: Final = "The sandbox was asked for this."
_REMEDY: Final = "Post it again without `sandbox:` in the label, or retry the job."

WARNINGS_OF_A_FIT: Final = (
    "body-outside-picture",
    "left-and-right-may-be-swapped",
    "low-silhouette-overlap",
    "segmentation-doubtful",
    "shoulders-and-hips-disagree",
)
WARNINGS_OF_A_SCAN: Final = ("different-people", "given-contradicted")


def end_as_asked(
    ending: str | None,
    reports: Sequence[Report],
    observe: Callable[[Report], None],
    *,
    pictures: int = 1,
) -> None:
    """Take as long as is asked for, reporting meanwhile, or end the job without a result.

    What is said of one of several ``pictures`` is said of the first.

    Returns where it is to succeed, also with a result that :func:`judged` makes another.

    Raises
    ------
    UnusableInputError, ProblemError, MemoryError, RuntimeError
        As a job that ends so does.
    """
    if ending is None or ending == WARNINGS or ending in VERDICTS:
        observe(reports[-1])
        return
    lasting_s = slowness_s(ending)
    if lasting_s is not None:
        for report in reports:
            observe(report)
            time.sleep(lasting_s / len(reports))
        return
    if ending in BY_ACCIDENT:
        _fail(ending)
    field = {**UNUSABLE_PICTURES, **UNUSABLE_FOR_DERIVATIONS}[ending]
    if pictures > 1 and field in OF_A_VIEW:
        field = f"views.0.{field}"
    raise UnusableInputError(FieldProblem(field=field, code=ending, reason=_ASKED, remedy=_REMEDY))


def judged(result: AnyFitResult, ending: str | None) -> AnyFitResult:
    """The result with the verdict or warnings that are asked for; its first view is to blame."""
    if ending == WARNINGS:
        codes = WARNINGS_OF_A_FIT if isinstance(result, FitResult) else WARNINGS_OF_A_SCAN
        asked = tuple(FitWarning(code=code, message=_ASKED) for code in codes)
        return result.model_copy(update={"warnings": (*result.warnings, *asked)})
    if ending is None or ending not in VERDICTS:
        return result
    verdict = {"verdict": VERDICTS[ending], "outcome_explanation": _ASKED}
    blamed = verdict | {"outcome": Outcome.POOR_FIT}
    nothing = {"measurements": ()}
    whole = nothing | {"stages": tuple(stage.model_copy(update=nothing) for stage in result.stages)}
    if isinstance(result, FitResult):
        return result.model_copy(update=whole | blamed)
    first, *others = result.views
    views = (first.model_copy(update=blamed), *others)
    return result.model_copy(update=whole | verdict | {"views": views})


def _fail(ending: str) -> NoReturn:
    match ending:
        case "fit-crashed":
            os.kill(os.getpid(), signal.SIGKILL)
        case "out-of-memory":
            raise MemoryError
        case "input-gone":
            raise ProblemError(input_gone())
        case "no-process":
            raise ProblemError(no_process())
        case "storage-full":
            raise ProblemError(no_storage(StorageFullError()))
        case "storage-unavailable":
            raise ProblemError(no_storage(BlobsUnavailableError()))
        case "time-limit-exceeded":
            raise ProblemError(too_slow(Settings().job_time_limit_s))
        case _:
            pass
    raise RuntimeError(_ASKED)
