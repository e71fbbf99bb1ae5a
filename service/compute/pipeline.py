"""The pipeline of the service: the fitter between two translations."""

from collections.abc import Callable
from typing import Final

from api_schemas.products.base import ProductResult
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.export import result_files, tapes_json
from fitter.export.display import png
from fitter.export.views import BodyView, preview
from fitter.fits.equipment import Equipment
from fitter.fits.pipeline import fit
from fitter.result import FitResult
from service.compute import translate
from service.compute.fit_results import fit_result
from service.compute.pipeline_port import (
    Made,
    PipelineInput,
    PipelineOutput,
    ProductInput,
    UnusableInputError,
)
from service.compute.products import maker_of
from service.compute.products.finished_fit import finished_fit
from service.compute.tasks import job_tasks
from service.jobs.inputs import BODY, PERSON, TAPES
from service.jobs.records import Report

_SEEN_FROM: Final = (("front", 0.0), ("side", 90.0), ("back", 180.0))
"""What ``body.png`` shows, and how far the onlooker has walked round, degrees."""


def run(job: PipelineInput, observe: Callable[[Report], None]) -> PipelineOutput:
    """Fit one body to all pictures; see :class:`service.compute.pipeline_port.Pipeline`."""
    request = translate.fit_request(job.request, job.pictures, max_pixels=job.max_pixels)
    equipment = Equipment(models=job.models, detector_weights=job.detector)
    try:
        found = fit(
            request, equipment, observer=lambda progress: observe(translate.report(progress))
        )
        prepared = equipment.model(found.person.gender)
        model = prepared.operators.model
        files = result_files(found, model=model, images=[each.image for each in job.pictures])
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error
    except DetectorUnavailableError as error:
        field = translate.proposed_field(job.request)
        raise UnusableInputError(translate.detector_problem(error, field=field)) from error
    files[PERSON] = found.person.to_bytes()
    files[TAPES] = tapes_json(found, prepared.measuring)
    files[BODY] = _from_all_round(found)
    return PipelineOutput(result=fit_result(found, part_names=model.part_names), files=files)


def _from_all_round(found: FitResult) -> bytes:
    body = found.canonical_vertices
    views = [BodyView(label=label, vertices=body, degrees=degrees) for label, degrees in _SEEN_FROM]
    return png(preview(views, found.triangles))


def make(product: ProductInput, observe: Callable[[Report], None]) -> Made[ProductResult]:
    """Make a product of a fit; see :class:`service.compute.pipeline_port.Pipeline`."""
    kind = product.options.kind

    def report(progress: float) -> None:
        observe(Report(stage=kind, progress=progress))

    report(0.0)
    try:
        fit = finished_fit(product.files, max_pixels=product.max_pixels, models=product.models)
        return maker_of(kind)(fit, product.options, report)
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error


TASKS: Final = job_tasks(run, make)
