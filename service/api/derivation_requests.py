"""A request for a derivation, and the file that may come with it."""

from collections.abc import Mapping
from dataclasses import dataclass

from fastapi import Request
from starlette.concurrency import run_in_threadpool

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivations import DerivationRequest
from api_schemas.problems import FieldProblem
from service.api.derivation_kinds import FORM_PARTS, needs_of
from service.api.job_inputs import File
from service.api.json_bodies import JSON, media_type, read_json_text, unsupported
from service.api.uploads import MULTIPART, read_request_and_files
from service.submissions.refusal import refused
from service.submissions.validation import parsed


@dataclass(frozen=True, slots=True, kw_only=True)
class Sent:
    """The request as JSON text, and the files sent with it, by the names of their parts."""

    text: bytes
    files: Mapping[str, File]


async def read_derivation(
    request: Request, *, max_pixels: int
) -> tuple[AnyDerivationOptions, Sent]:
    """Read the request: JSON, or a form with it and a file.

    Raises
    ------
    RefusedError, ProblemError
        If it is neither, or its content is invalid.
    """
    if media_type(request) == JSON:
        text, parts = await read_json_text(request), {}
        asked = parsed(DerivationRequest, text, whole="body", called="the body").root
    elif media_type(request) == MULTIPART:
        text, parts = await read_request_and_files(request, tuple(FORM_PARTS))
        asked = parsed(DerivationRequest, text, whole="request", called="the part 'request'").root
    else:
        raise unsupported(
            request,
            remedy=f"Send {JSON}, or {MULTIPART} with the parts 'request' and "
            f"{' or '.join(map(repr, FORM_PARTS))}.",
            accepted=f"{JSON}, {MULTIPART}",
        )
    _refuse_wrong_parts(asked, parts)
    files = await run_in_threadpool(_checked, asked, parts, max_pixels)
    return asked, Sent(text=text, files=files)


def _checked(
    asked: AnyDerivationOptions, parts: Mapping[str, bytes], max_pixels: int
) -> dict[str, File]:
    return {
        name: File(content=content, media_type=FORM_PARTS[name].check(content, asked, max_pixels))
        for name, content in parts.items()
    }


def _refuse_wrong_parts(asked: AnyDerivationOptions, parts: Mapping[str, bytes]) -> None:
    needs = needs_of(asked)
    taken = None if needs.part is None else needs.part.name
    if taken is not None and needs.part_is_for is not None and taken not in parts:
        raise refused(
            FieldProblem(
                field=taken,
                code="missing",
                reason=f"The part '{taken}' is missing, which {needs.part_is_for}.",
                remedy=f"Send {MULTIPART} with the parts 'request' and '{taken}'.",
            )
        )
    for name in parts:
        if name != taken:
            raise refused(
                FieldProblem(
                    field=name,
                    code="unknown-field",
                    reason=f"This request for a derivation of kind {asked.kind} takes no part "
                    f"'{name}'.",
                    remedy="Send the request alone, as JSON, or ask for "
                    f"{FORM_PARTS[name].sent_for}.",
                )
            )
