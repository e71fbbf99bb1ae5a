"""The inputs of a job, and how they get into the job's own scope."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final
from uuid import UUID

from api_schemas.problems import problem
from api_schemas.webhooks import WebhookTarget
from service.api.context import ApiContext
from service.api.job_routes import find
from service.api.json_bodies import JSON
from service.api.problems import ProblemError, not_found
from service.api.storage import erase_at_once
from service.blobs import BlobMissingError
from service.engine.port import StoredBlob
from service.engine.tenant_jobs import TenantJobs
from service.jobs.states import ACTIVE
from service.webhooks.targets import read_target

COPIED_AT_ONCE: Final = 2
"""For how many jobs a process makes copies at the same time: each holds one file in memory, and a
request of a few hundred bytes can ask for a gigabyte of them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class File:
    """Bytes that came with the request."""

    content: bytes
    media_type: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Copy:
    """A blob of another job, to be copied."""

    scope: str
    blob: StoredBlob


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """The inputs of a job; ``options`` is the request as JSON.

    ``pictures`` is how many pictures of a person are sent for it, where it waits as so many jobs.
    ``label`` is what the caller calls the person.
    """

    kind: str
    options: bytes
    files: Mapping[str, File | Copy]
    pictures: int = 1
    label: str | None = None
    webhook: WebhookTarget | None

    @property
    def brought_bytes(self) -> int:
        """How much of it came with the request."""
        brought = (each for each in self.files.values() if isinstance(each, File))
        return len(self.options) + sum(len(file.content) for file in brought)

    @property
    def has_copies(self) -> bool:
        """Whether any of it is read from storage."""
        return any(isinstance(each, Copy) for each in self.files.values())


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredInputs:
    """The inputs as blobs in the job's scope."""

    options: StoredBlob
    files: Mapping[str, StoredBlob]
    webhook: StoredBlob | None


def store_inputs(context: ApiContext, job_id: str, inputs: Inputs) -> StoredInputs:
    """Store all inputs in the job's scope, one file after the other; all or nothing.

    Raises
    ------
    ProblemError
        If something to be copied is gone.
    BlobsUnavailableError
        If the storage does not answer.
    """
    try:
        return StoredInputs(
            options=_stored_json(context, job_id, inputs.options),
            files={name: _stored(context, job_id, file) for name, file in inputs.files.items()},
            webhook=None
            if inputs.webhook is None
            else _stored_json(context, job_id, inputs.webhook.model_dump_json().encode()),
        )
    except Exception:
        erase_at_once(context.blobs, job_id)
        raise


def inputs_again(context: ApiContext, jobs: TenantJobs, job_id: UUID) -> Inputs:
    """Copies of all that a job was made of that has ended.

    Raises
    ------
    ProblemError
        If it has not ended, or is gone.
    """
    record = find(jobs, job_id)
    if record.state in ACTIVE:
        raise ProblemError(
            problem(
                "not-ended",
                detail=f"The job is {record.state}.",
                remedy="Wait for its end, or cancel it first.",
            )
        )

    try:
        options = context.blobs.get(record.id, record.options.digest)
        webhook = read_target(context.blobs, record)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
    return Inputs(
        kind=record.kind,
        options=options,
        files={name: Copy(scope=record.id, blob=blob) for name, blob in record.inputs.items()},
        pictures=record.pictures,
        label=record.label,
        webhook=webhook,
    )


def _stored_json(context: ApiContext, job_id: str, text: bytes) -> StoredBlob:
    return StoredBlob(digest=context.blobs.put(job_id, text), media_type=JSON)


def _stored(context: ApiContext, job_id: str, file: File | Copy) -> StoredBlob:
    if isinstance(file, File):
        digest = context.blobs.put(job_id, file.content)
        return StoredBlob(digest=digest, media_type=file.media_type)
    try:
        content = context.blobs.get(file.scope, file.blob.digest)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
    context.blobs.put(job_id, content)
    return file.blob
