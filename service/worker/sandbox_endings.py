"""How a sandbox lets a job end as its caller asked for."""

import os
import signal
import time
from collections.abc import Callable, Sequence
from typing import Final, NoReturn, TypeVar

from api_schemas.problems import FieldProblem
from api_schemas.results import FitResult, FitWarning, Outcome
from api_schemas.scans import ScanResult
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
from service.settings import Settings
from service.worker.endings import input_gone, no_process, no_storage, too_slow
from service.worker.pipeline_port import ProblemError, UnusableInputError

_ASKED: Final = "The sandbox was asked for this."
_REMEDY: Final = "Post it again without `sandbox:` in the label, or retry the job."

WARNINGS_OF_A_FIT: Final = (
    "body-outside-picture",
    "left-and-right-may-be-swapped",
    "low-silhouette-overlap",
    "segmentation-doubtful",
    "several-people",
    "shoulders-and-hips-disagree",
)
WARNINGS_OF_A_SCAN: Final = ("different-people", "given-contradicted")


def end_as_asked(
    ending: str | None, reports: Sequence[Report], observe: Callable[[Report], None]
) -> None:
    """Take as long as is asked for, reporting meanwhile, or end the job without a result.

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
    raise UnusableInputError(FieldProblem(field=field, code=ending, reason=_ASKED, remedy=_REMEDY))


def of_first_view(error: UnusableInputError) -> UnusableInputError:
    """The same of a scan: what is said of a picture is said of its first."""
    if error.error.field not in OF_A_VIEW:
        return error
    named = error.error.model_copy(update={"field": f"views.0.{error.error.field}"})
    return UnusableInputError(named)


def judged_fit(result: FitResult, ending: str | None) -> FitResult:
    """The result with the verdict or the warnings that are asked for."""
    result = _warned(result, ending, WARNINGS_OF_A_FIT)
    if ending is None or ending not in VERDICTS:
        return result
    return result.model_copy(
        update={
            "verdict": VERDICTS[ending],
            "outcome": Outcome.POOR_FIT,
            "outcome_explanation": _ASKED,
            "measurements": (),
            "stages": tuple(
                stage.model_copy(update={"measurements": ()}) for stage in result.stages
            ),
        }
    )


def judged_scan(result: ScanResult, ending: str | None) -> ScanResult:
    """The same of a scan; its first view is the one to blame."""
    result = _warned(result, ending, WARNINGS_OF_A_SCAN)
    if ending is None or ending not in VERDICTS:
        return result
    verdict = {"verdict": VERDICTS[ending], "outcome_explanation": _ASKED}
    first, *others = result.views
    blamed = first.model_copy(update={**verdict, "outcome": Outcome.POOR_FIT})
    return result.model_copy(update={**verdict, "measurements": (), "views": (blamed, *others)})


Result = TypeVar("Result", FitResult, ScanResult)


def _warned(result: Result, ending: str | None, codes: Sequence[str]) -> Result:
    if ending != WARNINGS:
        return result
    asked = tuple(FitWarning(code=code, message=_ASKED) for code in codes)
    return result.model_copy(update={"warnings": (*result.warnings, *asked)})


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
