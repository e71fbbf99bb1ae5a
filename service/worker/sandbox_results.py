"""The results of a sandbox: those of the packaged samples, made once by the real pipeline."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Final

from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivations import DerivationRequest
from api_schemas.requests import FitRequest
from api_schemas.results import FitWarning
from api_schemas.scans import ScanRequest
from fitter.vocabulary.choices import Gender
from service.demo_data.sample import (
    load_sample,
    load_scan_sample,
    load_woman,
)
from service.engine.port import Report
from service.jobs.inputs import PERSON, REQUEST, SentPicture, named_pictures
from service.submissions.submission import check_submission
from service.worker import pipeline
from service.worker.artifacts import with_result_document
from service.worker.pipeline_port import (
    AnyFitOptions,
    DerivationInput,
    DerivationOutput,
    PipelineInput,
    PipelineOutput,
)

MAX_PIXELS: Final = 1_000_000

CANNED: Final = FitWarning(
    code="sandbox",
    message="This is a sandbox: the result is that of a sample, whatever was sent.",
)
"""What every result says of itself."""

_KEPT: Final[tuple[Mapping[str, Any], ...]] = (
    {"kind": "animation"},
    {"kind": "texture", "size": 512},
    {"kind": "caricature", "factor": 2.0},
)
"""Derivations that take too long to be made at once: 0.4 to 3 s each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CannedFit:
    """The fit of a sample, with its pictures, its request and what it reported."""

    output: PipelineOutput
    pictures: tuple[SentPicture[bytes], ...]
    options: AnyFitOptions
    reports: tuple[Report, ...]

    @property
    def derivation_inputs(self) -> dict[str, bytes]:
        """What any derivation of it can need."""
        files = with_result_document(self.output.result, self.output.artifacts)
        request = self.options.model_dump_json().encode()
        return files | named_pictures(self.pictures) | {REQUEST: request}


@dataclass(frozen=True, slots=True, kw_only=True)
class CannedResults:
    """All of them; ``pictures`` has the picture each ``person.npz`` was fitted to."""

    fits: Mapping[Gender, CannedFit]
    scan: CannedFit
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
    men_and_women = [
        _fit(FitRequest.model_validate_json(each.request), [each.image], folders)
        for each in (load_sample(), load_woman())
    ]
    both = load_scan_sample()
    scan = _fit(ScanRequest.model_validate_json(both.request), both.images, folders)
    return CannedResults(
        fits={fit.options.gender: fit for fit in men_and_women},
        scan=scan,
        derived=_derived(men_and_women[0].derivation_inputs, folders),
        pictures={
            fit.output.artifacts[PERSON]: fit.pictures[0].image for fit in (*men_and_women, scan)
        },
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Folders:
    models: Path | None
    detector: Path | None


def _fit(asked: FitRequest | ScanRequest, images: Sequence[bytes], folders: _Folders) -> CannedFit:
    pictures = tuple(SentPicture(image, None) for image in images)
    checked = check_submission(asked, pictures, max_pixels=MAX_PIXELS)
    reports: list[Report] = []
    output = pipeline.run(
        PipelineInput(
            options=checked.options,
            pictures=pictures,
            max_pixels=MAX_PIXELS,
            models=folders.models,
            detector=folders.detector,
        ),
        reports.append,
    )
    said = output.result.model_copy(update={"warnings": (CANNED, *output.result.warnings)})
    return CannedFit(
        output=replace(output, result=said),
        pictures=pictures,
        options=checked.options,
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
                max_pixels=MAX_PIXELS,
                models=folders.models,
                detector=folders.detector,
            ),
            lambda _: None,
        )
        for options in asked
    }
