"""The inputs of a fit, and how they get into the fit's own scope."""

from collections.abc import Mapping
from dataclasses import dataclass

from api_schemas.jobs import WebhookTarget
from service.api.context import ApiContext
from service.api.json_bodies import JSON
from service.api.storage import erase_at_once
from service.jobs.records import StoredBlob


@dataclass(frozen=True, slots=True, kw_only=True)
class File:
    """Bytes that came with the request."""

    content: bytes
    media_type: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """The inputs of a fit; ``options`` is the request as JSON.

    ``pictures`` is how many pictures of a person are sent for it, where it waits as so many fits.
    ``label`` is what the caller calls the person.
    """

    options: bytes
    files: Mapping[str, File]
    pictures: int
    label: str | None
    webhook: WebhookTarget | None

    @property
    def size(self) -> int:
        """How many bytes came with the request."""
        return len(self.options) + sum(len(file.content) for file in self.files.values())


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredInputs:
    """The inputs as blobs in the fit's scope."""

    options: StoredBlob
    files: Mapping[str, StoredBlob]
    webhook: StoredBlob | None


def store_inputs(context: ApiContext, fit_id: str, inputs: Inputs) -> StoredInputs:
    """Store all inputs in the fit's scope, one file after the other; all or nothing.

    Raises
    ------
    BlobsUnavailableError
        If the storage does not answer.
    """

    def stored(content: bytes, media_type: str) -> StoredBlob:
        return StoredBlob(digest=context.blobs.put(fit_id, content), media_type=media_type)

    try:
        return StoredInputs(
            options=stored(inputs.options, JSON),
            files={
                name: stored(file.content, file.media_type) for name, file in inputs.files.items()
            },
            webhook=None
            if inputs.webhook is None
            else stored(inputs.webhook.model_dump_json().encode(), JSON),
        )
    except Exception:
        erase_at_once(context.blobs, fit_id)
        raise
