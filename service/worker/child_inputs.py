"""What a child was given, as the pipeline takes it."""

from collections.abc import Mapping
from uuid import UUID

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivations import DerivationRequest
from api_schemas.requests import FitOptions
from api_schemas.scans import ScanOptions
from service.jobs.inputs import IMAGE, MASK, SANDBOX, image_of, mask_of, own_and_others
from service.worker.child_tasks import ChildSetup, GivenTask
from service.worker.pipeline_port import DerivationInput, PipelineInput, ScanInput, ScanPicture


def fit_input(setup: ChildSetup, given: GivenTask) -> PipelineInput:
    """One picture."""
    return PipelineInput(
        options=FitOptions.model_validate_json(given.options),
        image=given.inputs[IMAGE],
        mask=given.inputs.get(MASK),
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
        ending=_ending(given.inputs),
    )


def scan_input(setup: ChildSetup, given: GivenTask) -> ScanInput:
    """Several pictures of one person."""
    asked = ScanOptions.model_validate_json(given.options)
    return ScanInput(
        options=asked,
        pictures=tuple(
            ScanPicture(
                image=given.inputs[image_of(number)], mask=given.inputs.get(mask_of(number))
            )
            for number in range(len(asked.views))
        ),
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
        ending=_ending(given.inputs),
    )


def derivation_input(setup: ChildSetup, given: GivenTask) -> DerivationInput[AnyDerivationOptions]:
    """What a fit left, and what came with the request."""
    own, others = own_and_others(given.inputs)
    fit_id = given.task.fit_id
    return DerivationInput(
        options=DerivationRequest.model_validate_json(given.options).root,
        inputs=own,
        others=others,
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
        fit_id=None if fit_id is None else UUID(fit_id),
        ending=_ending(given.inputs),
    )


def _ending(inputs: Mapping[str, bytes]) -> str | None:
    return inputs[SANDBOX].decode() if SANDBOX in inputs else None
