"""Read multipart bodies."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any, Final

from fastapi import Request
from fastapi.datastructures import FormData
from pydantic import BaseModel
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException

from api_schemas.problems import FieldProblem, field_problem, problem
from service.api.json_bodies import JSON, json_content, media_type, unsupported
from service.api.problems import ProblemError
from service.api.storage import disk_full
from service.jobs.blobs_local import FULL

NEEDED_PARTS: Final = ("image", "request")
FEW_PARTS: Final = 3

MULTIPART: Final = "multipart/form-data"
MAX_REQUEST_PART_BYTES: Final = 1_000_000

PICTURE_TYPES: Final = "image/jpeg, image/png, image/webp, image/heic"


def file_part(description: str) -> dict[str, str]:
    """Describe a part of a form that is a file."""
    return {"type": "string", "format": "binary", "description": description}


async def read_image(request: Request) -> bytes:
    """Read the only part of an upload that is just a picture.

    Raises
    ------
    ProblemError
        If the body is not a multipart form, or has parts other than ``image``.
    """
    if media_type(request) != MULTIPART:
        raise unsupported(
            request, remedy=f"Send {MULTIPART} with the part 'image'.", accepted=MULTIPART
        )
    return (await _parts(request, needed=("image",), known=("image",)))["image"]


async def read_image_and_request(request: Request) -> tuple[bytes, bytes]:
    """Read a picture and the request about it: JSON as a string or a file, ``{}`` if none came.

    Raises
    ------
    ProblemError
        As :func:`read_image`.
    """
    if media_type(request) != MULTIPART:
        raise unsupported(
            request,
            remedy=(
                f"Send {MULTIPART} with the part 'image', or application/json with the image_id of "
                "an uploaded picture."
            ),
            accepted=f"{MULTIPART}, application/json",
        )
    parts = await _parts(request, needed=("image",), known=NEEDED_PARTS)
    return parts["image"], parts.get("request", b"{}")


async def read_request_and_files(
    request: Request, names: Sequence[str]
) -> tuple[bytes, dict[str, bytes]]:
    """Read the part ``request``, JSON as a string or a file, and files, all of them optional.

    Raises
    ------
    ProblemError
        If the request is missing, or a part is unknown or repeated.
    """
    parts = await _parts(request, needed=("request",), known=("request", *names))
    return parts.pop("request"), parts


async def read_fit_form(
    request: Request, *, most: int
) -> tuple[bytes, tuple[bytes, ...], tuple[bytes, ...]]:
    """Read the part ``request``, JSON, and the parts ``image`` and ``mask`` in their order.

    Raises
    ------
    ProblemError
        If the body is not a multipart form, a part is missing or unknown, or the request comes more
        than once. Pictures may be more than ``most`` by one, for the caller to refuse.
    """
    known = ("request", "image", "mask")
    form = await _form(request, known, most=2 * most + 2)
    try:
        _check_parts(form, needed=("request", "image"), known=known, single=("request",))
        (text,) = [await _content(part) for part in form.getlist("request")]
        images = [await _content(part) for part in form.getlist("image")]
        masks = [await _content(part) for part in form.getlist("mask")]
    finally:
        await form.close()
    return text, tuple(images), tuple(masks)


async def _parts(
    request: Request, *, needed: Sequence[str], known: Sequence[str]
) -> dict[str, bytes]:
    form = await _form(request, known, most=FEW_PARTS)
    try:
        _check_parts(form, needed=needed, known=known, single=known)
        return {name: await _content(part) for name, part in form.items()}
    finally:
        await form.close()


async def _form(request: Request, known: Sequence[str], *, most: int) -> FormData:
    try:
        form = await request.form(
            max_files=most, max_fields=most, max_part_size=MAX_REQUEST_PART_BYTES
        )
    except HTTPException as error:
        raise _malformed(error.detail, known) from error
    except UnicodeError as error:
        raise _malformed(_NO_TEXT, known) from error
    except OSError as error:
        # Large parts are stored in the folder of temporary files until they are complete.
        if error.errno in FULL:
            raise disk_full() from error
        raise
    if not all(_is_text(text) for item in form.multi_items() for text in item):
        await form.close()
        raise _malformed(_NO_TEXT, known)
    return form


_NO_TEXT: Final = "In the charset that it names, it is no text."


def _is_text(value: UploadFile | str) -> bool:
    """Whether a name or a content can be encoded: some charsets can express lone surrogates."""
    if isinstance(value, str):
        try:
            value.encode()
        except UnicodeEncodeError:
            return False
    return True


def _malformed(reason: str, known: Sequence[str]) -> ProblemError:
    return ProblemError(
        problem(
            "malformed-request",
            detail=f"The multipart body cannot be read: {reason}",
            remedy=f"Send these parts and no others: {', '.join(known)}.",
        )
    )


def _check_parts(
    form: FormData, *, needed: Sequence[str], known: Sequence[str], single: Sequence[str]
) -> None:
    names = [name for name, _ in form.multi_items()]
    errors = [*_missing(names, needed), *_unknown(names, known)]
    errors += [
        FieldProblem(
            field=name,
            code="repeated-field",
            reason=f"The part '{name}' comes more than once.",
            remedy="Send it once.",
        )
        for name in dict.fromkeys(names)
        if name in single and names.count(name) > 1
    ]
    if errors:
        raise ProblemError(field_problem("invalid-request", *errors))


def _missing(names: Collection[str], needed: Sequence[str]) -> Iterator[FieldProblem]:
    for name in needed:
        if name not in names:
            yield FieldProblem(
                field=name,
                code="missing",
                reason=f"The part '{name}' is missing.",
                remedy=f"Send a multipart part named '{name}'.",
            )


def _unknown(names: Iterable[str], known: Sequence[str]) -> Iterator[FieldProblem]:
    for name in dict.fromkeys(names):
        if name not in known:
            yield FieldProblem(
                field=name,
                code="unknown-field",
                reason=f"There is no part called '{name}'.",
                remedy=f"Parts there are: {', '.join(known)}.",
            )


async def _content(part: UploadFile | str) -> bytes:
    return part.encode() if isinstance(part, str) else await part.read()


def picture_form(asked: type[BaseModel] | None = None) -> dict[str, Any]:
    """Content of a body with the part ``image``, and with an optional ``request`` of that type."""
    properties: dict[str, Any] = {"image": file_part("JPEG, PNG, WebP or HEIC.")}
    encoding: dict[str, Any] = {"image": {"contentType": PICTURE_TYPES}}
    if asked is not None:
        properties["request"] = json_content(asked)["schema"]
        encoding["request"] = {"contentType": JSON}
    return {
        MULTIPART: {
            "schema": {
                "type": "object",
                "additionalProperties": False,
                "required": ["image"],
                "properties": properties,
            },
            "encoding": encoding,
        }
    }
