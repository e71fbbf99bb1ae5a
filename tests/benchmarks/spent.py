"""Processor time of a fit, which a busy machine leaves alone."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from fitter.export.bundle import result_files
from fitter.fits.equipment import prepared_model
from fitter.fits.pipeline import fit
from fitter.request import FitRequest


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedFit:
    """Processor seconds of a fit, and of the making of its pictures and meshes."""

    fit_s: float
    export_s: float


def processor_s(action: Callable[[], object]) -> float:
    """Processor seconds of this process, all its threads."""
    began = time.process_time()
    action()
    return time.process_time() - began


def timed_fit(request: FitRequest) -> TimedFit:
    """Fit, then make the files."""
    began = time.process_time()
    result = fit(request)
    fitted = time.process_time()
    model = prepared_model(result.person.gender).operators.model
    result_files(result, model=model, images=[view.image for view in request.views])
    return TimedFit(fit_s=fitted - began, export_s=time.process_time() - fitted)
