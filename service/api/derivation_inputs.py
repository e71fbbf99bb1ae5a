"""What a request for a derivation says and brings, and what its job gets of the fit."""

import codecs
from collections.abc import Collection
from dataclasses import dataclass
from typing import Final
from uuid import UUID

from fastapi import Request

from api_schemas.derivations import (
    AnimationOptions,
    AnyDerivationOptions,
    CombinedOptions,
    DerivationKind,
    DerivationRequest,
)
from api_schemas.jobs import JobState
from api_schemas.problems import FieldProblem, problem
from service.api.acceptance import File, Inputs
from service.api.context import ApiContext
from service.api.job_routes import find
from service.api.json_bodies import JSON, media_type, read_json_text, unsupported
from service.api.problems import ProblemError, not_found
from service.api.results import no_result
from service.api.uploads import MULTIPART, read_request_and_file
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, StoredBlob
from service.inputs import CLIP, OF_ITS_FIT, PERSON, other_person
from service.refusal import refused
from service.validation import parsed

MAX_CLIP_BYTES: Final = 32 * 1024 * 1024
"""What the fitter reads at most; a minute of motion capture is a tenth of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sent:
    """The request as JSON text, and the motion that came along."""

    text: bytes
    clip: bytes | None


async def read_derivation(request: Request) -> tuple[AnyDerivationOptions, Sent]:
    """Read the request: JSON, or a form with it and a motion.

    Raises
    ------
    RefusedError, ProblemError
        If it is neither, or says what cannot be.
    """
    if media_type(request) == JSON:
        text = await read_json_text(request)
        asked = parsed(DerivationRequest, text, whole="body", called="the body")
        return asked.root, Sent(text=text, clip=None)
    if media_type(request) != MULTIPART:
        raise unsupported(
            request,
            remedy=f"Send {JSON}, or {MULTIPART} with the parts 'request' and '{CLIP}'.",
            accepted=f"{JSON}, {MULTIPART}",
        )
    text, clip = await read_request_and_file(request, CLIP)
    asked = parsed(DerivationRequest, text, whole="request", called="the part 'request'")
    if not isinstance(asked.root, AnimationOptions):
        raise refused(
            FieldProblem(
                field=CLIP,
                code="unknown-field",
                reason=f"A {asked.root.kind} takes no motion.",
                remedy="Send the request alone, as JSON, or ask for an animation.",
            )
        )
    _check_clip(clip)
    return asked.root, Sent(text=text, clip=clip)


def _check_clip(clip: bytes) -> None:
    """Check what can be told of a BVH file without reading it."""
    if len(clip) > MAX_CLIP_BYTES:
        raise ProblemError(
            problem(
                "payload-too-large",
                field=CLIP,
                detail=f"The motion has {len(clip)} bytes, more than {MAX_CLIP_BYTES}.",
                remedy="Cut the clip, or lower its frame rate.",
            )
        )
    if not clip.removeprefix(codecs.BOM_UTF8).lstrip()[:9].upper() == b"HIERARCHY":
        raise refused(
            FieldProblem(
                field=CLIP,
                code="not-a-bvh",
                reason="The motion does not begin with HIERARCHY: it is no BVH file.",
                remedy="Export the motion as BVH.",
            )
        )


def derivation_inputs(
    context: ApiContext, fit_id: UUID, options: AnyDerivationOptions, clip: bytes | None
) -> Inputs:
    """Copy what a derivation needs of its fit, and of others it names.

    Raises
    ------
    ProblemError, RefusedError
        If the fit has no result, or another one is none of the caller's that succeeded.
    """
    fit = find(context.jobs, fit_id)
    if fit.state is not JobState.SUCCEEDED:
        raise ProblemError(no_result(fit))
    files = _files_of(context, fit, OF_ITS_FIT[DerivationKind(options.kind)])
    if isinstance(options, CombinedOptions):
        for index, other in enumerate(options.fits):
            person = _person_of_another(context, index, other, than=fit_id)
            files[other_person(index)] = person
    if clip is not None:
        files[CLIP] = File(content=clip, media_type="text/plain")
    return Inputs(
        kind=options.kind,
        options=options.model_dump_json(exclude={"webhook"}).encode(),
        files=files,
        webhook=options.webhook,
    )


def _files_of(context: ApiContext, fit: JobRecord, needed: Collection[str]) -> dict[str, File]:
    """Copies of a fit's inputs and files, so far as it has them."""
    kept = dict(fit.inputs) | {
        artifact.name: StoredBlob(digest=artifact.sha256, media_type=artifact.media_type)
        for artifact in fit.artifacts
    }
    try:
        return {
            name: File(content=context.blobs.get(fit.id, blob.digest), media_type=blob.media_type)
            for name, blob in kept.items()
            if name in needed
        }
    except BlobMissingError as error:
        raise not_found(what="such fit any more") from error


def _person_of_another(context: ApiContext, index: int, other: UUID, *, than: UUID) -> File:
    """The person of a fit that a request names beside its own."""
    record = None if other == than else context.jobs.job(str(other))
    person = None
    if record is not None and record.state is JobState.SUCCEEDED:
        person = _files_of(context, record, (PERSON,)).get(PERSON)
    if person is None:
        reason = "is the one it is derived from" if other == than else "has not succeeded here"
        raise refused(
            FieldProblem(
                field=f"fits.{index}",
                code="fits-unusable",
                reason=f"The fit {other} {reason}.",
                remedy="Name other fits of yours that have succeeded.",
            )
        )
    return person
