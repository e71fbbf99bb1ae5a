"""The resources that are jobs: fits, scans, and what is derived from either.

A scan is a fit of several pictures, and both have the same routes; they differ in their paths, in
the names of their operations and in the types of their answers, which are those of version 1.0.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import Depends, Path, Query
from pydantic import BaseModel

from api_schemas.base import WireModel
from api_schemas.derivations import (
    Derivation,
    DerivationPage,
    DerivationRequest,
    DerivationResult,
)
from api_schemas.jobs import Job, JobPage, JobStanding
from api_schemas.requests import FitOptions
from api_schemas.results import FitResult, ResultPart
from api_schemas.scans import (
    Scan,
    ScanDerivation,
    ScanDerivationPage,
    ScanOptions,
    ScanPage,
    ScanResult,
)
from service.api.context import Context
from service.api.job_routes import OfLabel, find
from service.engine.port import FIT, SCAN, JobRecord
from service.engine.tenant_jobs import TenantJobs
from service.representation.jobs import collection_path


@dataclass(frozen=True, slots=True, kw_only=True)
class JobResource:
    """Jobs below one path.

    Attributes
    ----------
    root
        The kind of the jobs, or of those they are derived from.
    noun
        What one of them is called.
    path, parameter
        Below the service's root, and the name of a job's id in it.
    parent
        The dependency that finds what they are derived from; None for fits and scans.
    jobs
        The dependency that gives the caller's.
    label
        The dependency that gives the label they are listed by.
    operations
        Names of operations, by what they do or return.
    tag, results_tag
        Where the documentation lists them.
    model, page, listed
        Types of the answers about one and about several, and the page's field that holds them.
    options, result
        Types of the request as it was understood, and of the result document.
    included
        The dependency that gives what of the document is asked for that is left out otherwise.
    holds, files, media_types
        What that document holds, two of the files, and the media types of those that are neither
        meshes nor JSON.
    erased
        What goes with a job that is erased.
    """

    root: str
    noun: str
    path: str
    parameter: str
    parent: Callable[..., JobRecord] | None = None
    jobs: Callable[..., TenantJobs]
    label: Callable[..., str | None]
    operations: Mapping[str, str]
    tag: str
    results_tag: str
    model: type[JobStanding]
    page: Callable[..., WireModel]
    listed: str
    options: type[BaseModel]
    result: type[BaseModel]
    included: Callable[..., frozenset[ResultPart]]
    holds: str
    files: str
    media_types: tuple[str, ...]
    erased: str

    @property
    def id(self) -> Any:
        """What FastAPI is to know of the parameter."""
        return Path(alias=self.parameter, title=self.parameter.replace("_", " ").title())

    @property
    def id_below(self) -> str:
        """Where a job lies below ``path``."""
        return f"/{{{self.parameter}}}"


def _operations(noun: str) -> dict[str, str]:
    """Names of operations, as generated clients have them: ``submit_fit``, ``get_fit_result``."""
    done = ("submit", "get", "cancel", "erase", "follow", "retry")
    read = ("request", "result", "artifact", "image", "mask")
    return (
        {"list": f"list_{noun}s"}
        | {verb: f"{verb}_{noun}" for verb in done}
        | {what: f"get_{noun}_{what}" for what in read}
    )


def _fits(context: Context) -> TenantJobs:
    return context.jobs[FIT]


def _scans(context: Context) -> TenantJobs:
    return context.jobs[SCAN]


def _by_label(label: OfLabel = None) -> str | None:
    return label


def _by_no_label() -> None:
    """What is derived from a fit is that fit's person's."""


Include = Annotated[
    list[ResultPart] | None,
    Query(description="`stages`: the body after each stage of the fit, some 70 kB more."),
]


def _included(include: Include = None) -> frozenset[ResultPart]:
    return frozenset(include or ())


def _whole() -> frozenset[ResultPart]:
    """What is derived is told in full."""
    return frozenset(ResultPart)


FITS: Final = JobResource(
    root=FIT,
    noun="fit",
    path=collection_path(FIT),
    parameter="fit_id",
    jobs=_fits,
    label=_by_label,
    operations=_operations("fit"),
    tag="fits",
    results_tag="results",
    model=Job,
    page=JobPage,
    listed="jobs",
    options=FitOptions,
    result=FitResult,
    included=_included,
    holds="camera, pose, shape, light, measurements, what was assumed",
    files="`body_posed.glb`, `overlay.png` and so on, as the job's links name them, or "
    "`body_posed.obj`, `measurements.csv`",
    media_types=("image/png", "application/zip"),
    erased="its picture, intermediate files and results. What was derived from it is stopped and "
    "erased too",
)

SCANS: Final = JobResource(
    root=SCAN,
    noun="scan",
    path=collection_path(SCAN),
    parameter="scan_id",
    jobs=_scans,
    label=_by_label,
    operations=_operations("scan"),
    tag="scans",
    results_tag="scans",
    model=Scan,
    page=ScanPage,
    listed="scans",
    options=ScanOptions,
    result=ScanResult,
    included=_included,
    holds="shape, measurements, every view's camera, pose and light",
    files="`body_canonical.glb`, `overlay_0.png` and so on, as the job's links name them, or "
    "`body_canonical.obj`, `measurements.csv`",
    media_types=("image/png", "application/zip"),
    erased="all its pictures, intermediate files and results. What was derived from it is stopped "
    "and erased too",
)


def _derived_from(
    source: JobResource, *, model: type[JobStanding], page: Callable[..., WireModel]
) -> JobResource:
    """What is derived from fits, or from scans."""

    def parent(
        jobs: Annotated[TenantJobs, Depends(source.jobs)], source_id: Annotated[UUID, source.id]
    ) -> JobRecord:
        return find(jobs, source_id)

    def below(
        jobs: Annotated[TenantJobs, Depends(source.jobs)],
        made_of: Annotated[JobRecord, Depends(parent)],
    ) -> TenantJobs:
        return jobs.derivations(made_of.id)

    return JobResource(
        root=source.root,
        noun="derivation",
        path=f"{source.path}/{{{source.parameter}}}/derivations",
        parameter="derivation_id",
        parent=parent,
        jobs=below,
        label=_by_no_label,
        operations=_operations(f"{source.noun}_derivation"),
        tag="derivations",
        results_tag="derivations",
        model=model,
        page=page,
        listed="derivations",
        options=DerivationRequest,
        result=DerivationResult,
        included=_whole,
        holds="what there is to say of it",
        files="`pose.png`, `body_reposed.glb` and so on, as the job's links name them, or "
        "`body_reposed.obj`",
        media_types=("image/png", "image/webp"),
        erased=f"its copies and results; the {source.noun} stays",
    )


OF_FITS: Final = _derived_from(FITS, model=Derivation, page=DerivationPage)
OF_SCANS: Final = _derived_from(SCANS, model=ScanDerivation, page=ScanDerivationPage)
