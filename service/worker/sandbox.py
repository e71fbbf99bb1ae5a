"""The pipeline of a sandbox: results of the packaged samples, at once, whatever was sent.

What the pictures show is looked at by nobody. Derivations that are quick are made of the canned
person as everywhere, by the options of the request; the others are canned too.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivations import DerivationRequest
from api_schemas.scans import ScanOptions
from service.engine.port import Report
from service.jobs.inputs import IMAGE, OVERLAY, PERSON
from service.worker import pipeline
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    PipelineInput,
    PipelineOutput,
)
from service.worker.sandbox_endings import end_as_asked, judged
from service.worker.sandbox_forms import scan_of_views
from service.worker.sandbox_results import MAX_PIXELS, CannedResults, canned_results
from service.worker.tasks import job_tasks


def run(job: PipelineInput, observe: Callable[[Report], None]) -> PipelineOutput:
    """Give the fit of the sample of that gender, or its scan with the views that were asked for."""
    canned = canned_results(job.models, job.detector)
    asked = job.options
    fit = canned.scan if isinstance(asked, ScanOptions) else canned.fits[asked.gender]
    end_as_asked(job.ending, fit.reports, observe, pictures=len(job.pictures))
    output = scan_of_views(fit.output, asked) if isinstance(asked, ScanOptions) else fit.output
    return replace(output, result=judged(output.result, job.ending))


def derive(
    job: DerivationInput[AnyDerivationOptions], observe: Callable[[Report], None]
) -> DerivationOutput[DerivedFiles]:
    """Give what is kept of that kind, or derive it from the canned person."""
    canned = canned_results(job.models, job.detector)
    kind = job.options.kind
    steps = [Report(stage=kind, progress=share / 10) for share in range(10)]
    end_as_asked(job.ending, steps, observe)
    if kind in canned.derived:
        return canned.derived[kind]
    return pipeline.derive(_with_sample(job, canned), observe)


def _with_sample(
    job: DerivationInput[AnyDerivationOptions], canned: CannedResults
) -> DerivationInput[AnyDerivationOptions]:
    """The job with the picture its person was fitted to, not the one that was sent."""
    if IMAGE not in job.inputs:
        return job
    # A person of an earlier version's sample is none of these: what is drawn of it is, if needed.
    picture = canned.pictures.get(job.inputs[PERSON], job.inputs.get(OVERLAY))
    inputs = {name: content for name, content in job.inputs.items() if name != IMAGE}
    return replace(job, inputs=inputs if picture is None else inputs | {IMAGE: picture})


TASKS: Final = job_tasks(run, derive)


_AT_ONCE: Final[tuple[Mapping[str, Any], ...]] = (
    {"kind": "pose", "pose": "standing"},
    {"kind": "body_composition"},
    {
        "kind": "size",
        "chart": {
            "sizes": [{"label": "M", "measurements": {"chest_girth": {"low": 90.0, "high": 100.0}}}]
        },
    },
)
"""One of each kind that is made anew for every job; what it loads is then there for all."""


def derive_all(models: Path | None, detector: Path | None) -> None:
    """Do everything once before the first job: make the results, and what is derived from them.

    Raises as :func:`service.worker.sandbox_results.canned_results` does.
    """
    first, *_ = canned_results(models, detector).fits.values()
    inputs = first.derivation_inputs
    for each in _AT_ONCE:
        derive(
            DerivationInput(
                options=DerivationRequest.model_validate_json(json.dumps(each)).root,
                inputs=inputs,
                max_pixels=MAX_PIXELS,
                models=models,
                detector=detector,
            ),
            lambda _: None,
        )
