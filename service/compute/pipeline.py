"""The tasks of jobs, a fit and its products: the fitter between two translations."""

import importlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, Final

from api_schemas.fit import FitRequest
from api_schemas.products import ProductRequest
from api_schemas.products.base import ProductResult
from fitter.applications.texture import picture_colours
from fitter.body.scape import ScapeEvaluator
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.export import result_files, tapes_json
from fitter.export.display import png
from fitter.export.views import BodyView, preview
from fitter.fits.equipment import Equipment
from fitter.fits.pipeline import fit
from fitter.result import FitResult
from service.compute import translate
from service.compute.fit_results import fit_result
from service.compute.products.finished_fit import FinishedFit, Made, finished_fit
from service.compute.products.finished_fit import Report as ReportShare
from service.compute.tasks import (
    OPTIONS,
    PRODUCT,
    ChildSetup,
    Observe,
    Parts,
    Task,
    UnusableInputError,
    with_result_document,
)
from service.jobs.inputs import BODY, PERSON, RESULT, TAPES, pictures_of
from service.jobs.records import FIT, Report

_SEEN_FROM: Final = (("front", 0.0), ("side", 90.0), ("back", 180.0))
"""Views of ``body.png``, and how far the onlooker has walked round, degrees."""


def fit_task(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
    """Fit one body to all pictures, which come by :func:`service.jobs.inputs.named_pictures`.

    The points of the request are named.
    """
    asked = FitRequest.model_validate_json(parts[OPTIONS])
    pictures = pictures_of(parts)
    request = translate.fit_request(asked, pictures, max_pixels=setup.max_pixels)
    equipment = Equipment(models=setup.models, detector_weights=setup.detector)
    try:
        found = fit(
            request, equipment, observer=lambda progress: observe(translate.report(progress))
        )
        prepared = equipment.model(found.person.gender)
        model = prepared.operators.model
        files = result_files(found, model=model, images=[each.image for each in pictures])
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error
    except DetectorUnavailableError as error:
        field = translate.proposed_field(asked)
        raise UnusableInputError(translate.detector_problem(error, field=field)) from error
    files[PERSON] = found.person.to_bytes()
    files[TAPES] = tapes_json(found, prepared.measuring)
    files[BODY] = _from_all_round(found, prepared.operators.evaluator)
    return with_result_document(fit_result(found, part_names=model.part_names), files)


def _from_all_round(found: FitResult, evaluator: ScapeEvaluator) -> bytes:
    """The body in the colours of its picture; of clay where it does not match that."""
    body, colours = found.canonical_vertices, None
    views = [BodyView(label=label, vertices=body, degrees=degrees) for label, degrees in _SEEN_FROM]
    if found.found.is_plausible:
        seen = found.views[0].pictures
        with suppress(InvalidInputError):
            colours = picture_colours(found.person, evaluator, seen.image, seen.segmentation)
    return png(preview(views, found.triangles, colours))


def product_task(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
    """Make a product of a fit's files and of the part that came with the request, if one did."""
    options = ProductRequest.model_validate_json(parts[OPTIONS]).root

    def report(progress: float) -> None:
        observe(Report(stage=options.kind, progress=progress))

    report(0.0)
    try:
        finished = finished_fit(parts, max_pixels=setup.max_pixels, models=setup.models)
        made = maker_of(options.kind)(finished, options, report)
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error
    return {**made.files, RESULT: made.result.model_dump_json().encode()}


def maker_of(kind: str) -> Callable[[FinishedFit, Any, ReportShare], Made[ProductResult]]:
    """Function that makes products of a kind; each takes options of its own, say ``PoseOptions``.

    It raises :class:`fitter.errors.InvalidInputError` if the request is at fault. A module is
    imported only when its product is asked for: no fit needs what it loads, and every process
    forked for a fit would carry it along.
    """
    return importlib.import_module(f"service.compute.products.{kind}").make


TASKS: Final[Mapping[str, Task]] = {FIT: fit_task, PRODUCT: product_task}
