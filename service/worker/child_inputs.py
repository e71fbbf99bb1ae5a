"""What a child was given, as the pipeline takes it."""

from collections.abc import Mapping
from typing import Final
from uuid import UUID

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivations import DerivationRequest
from api_schemas.requests import FitOptions
from api_schemas.scans import ScanOptions
from service.engine.port import FIT, SCAN
from service.jobs.inputs import SANDBOX, own_and_others, pictures_of
from service.worker.child_tasks import ChildSetup, GivenTask
from service.worker.pipeline_port import DerivationInput, PipelineInput

OPTIONS: Final[Mapping[str, type[FitOptions] | type[ScanOptions]]] = {
    FIT: FitOptions,
    SCAN: ScanOptions,
}
"""What is asked for, by the kind of a job that is no derivation."""


def fit_input(setup: ChildSetup, given: GivenTask) -> PipelineInput:
    """The pictures of one person."""
    return PipelineInput(
        options=OPTIONS[given.task.kind].model_validate_json(given.options),
        pictures=pictures_of(given.inputs),
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
        ending=_ending(given.inputs),
    )


def derivation_input(
    setup: ChildSetup, given: GivenTask, made_of: UUID
) -> DerivationInput[AnyDerivationOptions]:
    """What a fit left, and what came with the request."""
    own, others = own_and_others(given.inputs)
    return DerivationInput(
        options=DerivationRequest.model_validate_json(given.options).root,
        inputs=own,
        others=others,
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
        fit_id=made_of,
        ending=_ending(given.inputs),
    )


def _ending(inputs: Mapping[str, bytes]) -> str | None:
    return inputs[SANDBOX].decode() if SANDBOX in inputs else None
