"""The results of a sandbox: those of the packaged samples, made once by the real pipeline."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Final, TypeVar
from uuid import UUID

from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivations import DerivationRequest
from api_schemas.requests import FitOptions, Gender
from api_schemas.results import FitResult, FitWarning
from api_schemas.scans import ScanRequest, ScanResult
from service.demo_data.sample import (
    PictureSample,
    Sample,
    ScanSample,
    load_sample,
    load_scan_sample,
    load_woman,
)
from service.engine.port import Report
from service.jobs.inputs import IMAGE, PERSON, REQUEST, SentPicture
from service.submissions.submission import check_fit, check_submission
from service.worker import pipeline
from service.worker.artifacts import with_result_document
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    PipelineInput,
    PipelineOutput,
    ScanInput,
    ScanOutput,
    ScanPicture,
)

MAX_PIXELS: Final = 1_000_000

CANNED: Final = FitWarning(
    code="sandbox",
    message="This is a sandbox: the result is that of a sample, whatever was sent.",
)
"""What every result says of itself."""

NOBODY: Final = UUID(int=0)
"""Stands for fits that a derivation was made of, until it is somebody's."""

_KEPT: Final[tuple[Mapping[str, Any], ...]] = (
    {"kind": "report"},
    {"kind": "animation"},
    {"kind": "texture", "size": 512},
    {"kind": "caricature", "factor": 2.0},
    {"kind": "combined", "fits": [str(NOBODY)]},
)
"""Derivations that take too long to be made at once: 0.4 to 3 s each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CannedFit:
    """The fit of a sample, with its picture, its request and what it reported."""

    output: PipelineOutput
    image: bytes
    options: FitOptions
    reports: tuple[Report, ...]

    @property
    def derivation_inputs(self) -> dict[str, bytes]:
        """What any derivation of it can need."""
        files = with_result_document(self.output.result, self.output.artifacts)
        return files | {IMAGE: self.image, REQUEST: self.options.model_dump_json().encode()}


@dataclass(frozen=True, slots=True, kw_only=True)
class CannedScan:
    """The scan of the sample from the front and the side, and what it reported."""

    output: ScanOutput
    reports: tuple[Report, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CannedResults:
    """All of them; ``pictures`` has the picture each ``person.npz`` was fitted to."""

    fits: Mapping[Gender, CannedFit]
    scan: CannedScan
    derived: Mapping[str, DerivationOutput[DerivedFiles]]
    pictures: Mapping[bytes, bytes]


@cache
def canned_results(models: Path | None, detector: Path | None) -> CannedResults:
    """Fit the samples, and derive from the first what takes long.

    The fork server does so before it forks: jobs find it done.

    Raises
    ------
    UnusableInputError
        If models of one's own cannot be fitted to the samples.
    ModelFileError
        If a model is missing or damaged.
    """
    folders = _Folders(models=models, detector=detector)
    samples = (load_sample(), load_woman())
    fits = {fit.options.gender: fit for fit in (_fit(each, folders) for each in samples)}
    first, *_ = fits.values()
    sample = load_scan_sample()
    scan = _scan(sample, folders)
    return CannedResults(
        fits=fits,
        scan=scan,
        derived=_derived(first.derivation_inputs, folders),
        pictures={
            **{fit.output.artifacts[PERSON]: fit.image for fit in fits.values()},
            scan.output.artifacts[PERSON]: sample.images[0],
        },
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Folders:
    models: Path | None
    detector: Path | None


def _fit(sample: Sample | PictureSample, folders: _Folders) -> CannedFit:
    checked = check_fit(
        request=sample.request, image=sample.image, mask=None, max_pixels=MAX_PIXELS
    )
    reports: list[Report] = []
    output = pipeline.run(
        PipelineInput(
            options=checked.options,
            image=sample.image,
            mask=None,
            max_pixels=MAX_PIXELS,
            models=folders.models,
            detector=folders.detector,
        ),
        reports.append,
    )
    return CannedFit(
        output=replace(output, result=_said(output.result)),
        image=sample.image,
        options=checked.options,
        reports=tuple(reports),
    )


def _scan(sample: ScanSample, folders: _Folders) -> CannedScan:
    checked = check_submission(
        ScanRequest.model_validate_json(sample.request),
        [SentPicture(image, None) for image in sample.images],
        max_pixels=MAX_PIXELS,
    )
    reports: list[Report] = []
    output = pipeline.scan(
        ScanInput(
            options=checked.options,
            pictures=tuple(ScanPicture(image=image, mask=None) for image in sample.images),
            max_pixels=MAX_PIXELS,
            models=folders.models,
            detector=folders.detector,
        ),
        reports.append,
    )
    return CannedScan(
        output=replace(output, result=_said(output.result)),
        reports=tuple(reports),
    )


def _derived(
    inputs: Mapping[str, bytes], folders: _Folders
) -> dict[str, DerivationOutput[DerivedFiles]]:
    asked = [DerivationRequest.model_validate_json(json.dumps(each)).root for each in _KEPT]
    return {
        options.kind: pipeline.derive(
            DerivationInput(
                options=options,
                inputs=inputs,
                others=(inputs,),
                max_pixels=MAX_PIXELS,
                models=folders.models,
                detector=folders.detector,
                fit_id=NOBODY,
            ),
            lambda _: None,
        )
        for options in asked
    }


Result = TypeVar("Result", FitResult, ScanResult)


def _said(result: Result) -> Result:
    return result.model_copy(update={"warnings": (CANNED, *result.warnings)})
