"""The pipeline of the service: the fitter between two translations."""

from collections.abc import Callable

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivation_kinds.base import DerivedFiles
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.export import artifacts, tapes_json
from fitter.fits.equipment import Equipment
from fitter.fits.pipeline import fit
from service.engine.port import Report
from service.worker import translate
from service.worker.derivers import load_deriver
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    PipelineInput,
    PipelineOutput,
    ScanInput,
    ScanOutput,
    UnusableInputError,
)
from service.worker.scanning import scanned


def run(job: PipelineInput, observe: Callable[[Report], None]) -> PipelineOutput:
    """Fit one picture; see :class:`service.worker.pipeline_port.Pipeline`."""
    request = translate.fit_request(
        job.options, image=job.image, mask=job.mask, max_pixels=job.max_pixels
    )
    equipment = Equipment(models=job.models, detector_weights=job.detector)
    try:
        result = fit(
            request, equipment, observer=lambda progress: observe(translate.report(progress))
        )
        prepared = equipment.model(result.person.gender)
        model = prepared.operators.model
        files = artifacts(result, model=model, images=[job.image])
        files["person.npz"] = result.person.to_bytes()
        files["tapes.json"] = tapes_json(result, prepared.measuring)
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error
    except DetectorUnavailableError as error:
        raise UnusableInputError(translate.detector_problem(error)) from error
    return PipelineOutput(
        result=translate.fit_result(result, part_names=model.part_names), artifacts=files
    )


def scan(job: ScanInput, observe: Callable[[Report], None]) -> ScanOutput:
    """Measure one person; see :class:`service.worker.pipeline_port.Pipeline`."""
    return scanned(job, observe)


def derive(
    job: DerivationInput[AnyDerivationOptions], observe: Callable[[Report], None]
) -> DerivationOutput[DerivedFiles]:
    """Derive something from a fit; see :class:`service.worker.pipeline_port.Pipeline`."""
    kind = job.options.kind

    def report(progress: float) -> None:
        observe(Report(stage=kind, progress=progress))

    report(0.0)
    try:
        return load_deriver(kind)(job, report)
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error
    except DetectorUnavailableError as error:
        raise UnusableInputError(translate.detector_problem(error)) from error
