"""What the job of a derivation gets from its fit or scan, and from others it names."""

from collections.abc import Collection, Mapping
from uuid import UUID

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.jobs import JobState
from api_schemas.problems import FieldProblem
from service.api.artifacts import no_result
from service.api.derivation_kinds import needs_of
from service.api.job_inputs import Copy, File, Inputs
from service.api.problems import ProblemError
from service.engine.port import SCAN, JobExpiredError, JobRecord, StoredBlob, TenantJobs
from service.jobs.inputs import (
    IMAGE,
    OF_FIRST_VIEW,
    PERSON,
    REQUEST,
    of_other,
    pictures_of,
)
from service.submissions.refusal import RefusedError, refused


def derivation_inputs(
    jobs: TenantJobs, parent: JobRecord, options: AnyDerivationOptions, sent: Mapping[str, File]
) -> Inputs:
    """What a derivation needs from its fit or scan and from others it names, besides what was sent.

    ``jobs`` are the caller's fits if it is one, or scans.

    Raises
    ------
    ProblemError, RefusedError
        If that has no result, or another one that is named is not the caller's or has not
        succeeded.
    """
    if parent.state is not JobState.SUCCEEDED:
        raise ProblemError(no_result(parent))
    needs = needs_of(options)
    copies = _copies_of(parent, needs.of_fit)
    if needs.other_fits:
        _require(needs.of_others, copies, parent, field="kind")
    for index, (field, other) in enumerate(needs.other_fits.items()):
        of_another = _of_another(jobs, other, needs.of_others, field=field, than=parent)
        copies |= {of_other(name, index): copy for name, copy in of_another.items()}
    return Inputs(
        kind=options.kind,
        options=options.model_dump_json(exclude={"webhook"}).encode(),
        files={**copies, **sent},
        sources=tuple(map(str, needs.other_fits.values())),
        webhook=options.webhook,
    )


def _copies_of(parent: JobRecord, needed: Collection[str]) -> dict[str, Copy]:
    """Copies of those inputs and files that a fit has; of a scan its first picture's."""
    kept = dict(parent.inputs) | {REQUEST: parent.options}
    kept |= {
        artifact.name: StoredBlob(digest=artifact.sha256, media_type=artifact.media_type)
        for artifact in parent.artifacts
    }
    if parent.root == SCAN:
        # Who needs every picture needs none that stands for them.
        kept |= {
            name: kept[first]
            for name, first in OF_FIRST_VIEW.items()
            if first in kept and first not in needed
        }
    return {name: Copy(scope=parent.id, blob=kept[name]) for name in needed if name in kept}


def _of_another(
    jobs: TenantJobs, other: UUID, needed: Collection[str], *, field: str, than: JobRecord
) -> Mapping[str, Copy]:
    """The inputs and files of another fit or scan, which a field of the request names."""
    named = f"The {than.root} {other}"
    if str(other) == than.id:
        raise _unusable(field, f"{named} is the one it is derived from.", than.root)
    try:
        record = jobs.job(str(other))
    except JobExpiredError as error:
        raise _unusable(field, f"{named} has expired.", than.root) from error
    if record is None or record.state is not JobState.SUCCEEDED:
        raise _unusable(field, f"{named} has not succeeded here.", than.root)
    copies = _copies_of(record, needed)
    _require(needed, copies, record, field=field)
    return copies


def _require(
    needed: Collection[str], copies: Mapping[str, Copy], of: JobRecord, *, field: str
) -> None:
    """Refuse a fit made by an earlier version, which kept less than is of any use."""
    missing = [PERSON] if PERSON in needed and PERSON not in copies else []
    if IMAGE in needed and not pictures_of(copies):
        missing.append(IMAGE)
    if missing:
        raise refused(
            FieldProblem(
                field=field,
                code="fits-unusable",
                reason=f"The {of.root} {of.id} has no {' and no '.join(missing)}.",
                remedy="Fit its picture again.",
            )
        )


def _unusable(field: str, reason: str, root: str) -> RefusedError:
    return refused(
        FieldProblem(
            field=field,
            code="fits-unusable",
            reason=reason,
            remedy=f"Name other {root}s of yours that have succeeded.",
        )
    )
