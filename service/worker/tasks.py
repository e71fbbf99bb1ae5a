"""The tasks of jobs: from the bytes that the worker has of one to the files that are its result."""

from collections.abc import Callable, Mapping
from typing import Final

from pydantic import TypeAdapter

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivations import DerivationRequest
from api_schemas.fit import FitRequest
from service.engine.port import FIT
from service.jobs.inputs import pictures_of
from service.numerics.tasks import ChildSetup, Observe, Parts, Task
from service.worker.files import with_result_document
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    PipelineInput,
    PipelineOutput,
)

DERIVATION: Final = "derivation"
"""The task of every job that derives from a fit."""

OPTIONS: Final = "options"
"""The part that says what is asked for."""

STAGE_SECONDS: Final = "stage-seconds"
"""The part of a fit's answer that is no file of its result, but how long each stage took."""

SECONDS: Final[TypeAdapter[Mapping[str, float]]] = TypeAdapter(Mapping[str, float])

Run = Callable[[PipelineInput, Observe], PipelineOutput]
Derive = Callable[[DerivationInput[AnyDerivationOptions], Observe], DerivationOutput[DerivedFiles]]


def job_tasks(run: Run, derive: Derive) -> Mapping[str, Task]:
    """The table of a pipeline (:class:`service.worker.pipeline_port.Pipeline`)."""

    def fit(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
        fitted = run(fit_input(setup, parts), observe)
        seconds = SECONDS.dump_json(fitted.result.stage_seconds)
        files = with_result_document(fitted.result, fitted.files)
        return {**files, STAGE_SECONDS: seconds}

    def derivation(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
        derived = derive(derivation_input(setup, parts), observe)
        return with_result_document(derived.result, derived.files)

    return {FIT: fit, DERIVATION: derivation}


def fit_input(setup: ChildSetup, parts: Parts) -> PipelineInput:
    """The pictures of one person."""
    return PipelineInput(
        request=FitRequest.model_validate_json(parts[OPTIONS]),
        pictures=pictures_of(parts),
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
    )


def derivation_input(setup: ChildSetup, parts: Parts) -> DerivationInput[AnyDerivationOptions]:
    """What a fit left, and what came with the request."""
    return DerivationInput(
        options=DerivationRequest.model_validate_json(parts[OPTIONS]).root,
        inputs={name: part for name, part in parts.items() if name != OPTIONS},
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
    )
