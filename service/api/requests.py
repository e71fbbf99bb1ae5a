"""Requests as they come in: query parameters, and a body that is JSON or a form with files.

In a form JSON is the part ``request``, as a string or a file.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Generic, TypeVar

from fastapi import Request
from fastapi.datastructures import FormData
from pydantic import BaseModel
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException

from api_schemas.problems import FieldProblem, field_problem, shortened
from service.api.problems import ProblemError, documented, problem_error
from service.api.storage import disk_full
from service.jobs.blobs_local import FULL
from service.submissions.refusal import parsed

JSON: Final = "application/json"
MULTIPART: Final = "multipart/form-data"
MAX_JSON_BYTES: Final = 200_000
"""A size chart has 64 kB at most, and all else is smaller."""

REQUEST: Final = "request"
"""The part of a form that is JSON."""

SPARE_PARTS: Final = 2
"""Parts beyond those allowed that are read, for a refusal that names them."""

PREFIX: Final = "/v1/"
"""Probes and scrapes of metrics are not kept from their answer by what a monitor adds to them."""


Model = TypeVar("Model", bound=BaseModel)


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A part of a form, of which ``least`` to ``most`` come; ``kind`` is that of one in JSON."""

    description: str = ""
    media_types: str = "image/jpeg, image/png, image/webp, image/heic"
    kind: type[BaseModel] | None = None
    least: int = 0
    most: int = 1

    @property
    def schema(self) -> dict[str, Any]:
        """Its schema in the OpenAPI document."""
        if self.kind is not None:
            return json_content(self.kind)["schema"]
        file = {"type": "string", "format": "binary", "description": self.description}
        if self.most == 1:
            return file
        least = {"minItems": self.least} if self.least else {}
        return {"type": "array", **least, "maxItems": self.most, "items": file}


@dataclass(frozen=True, slots=True, kw_only=True)
class Received(Generic[Model]):
    """A request: its JSON as it came and as its type, and the files that came in a form."""

    text: bytes
    asked: Model
    files: Mapping[str, Sequence[bytes]]


def json_part(kind: type[BaseModel], *, least: int = 1) -> Part:
    """The part of a form that is JSON of a type."""
    return Part(media_types=JSON, kind=kind, least=least)


def json_content(kind: type[BaseModel]) -> dict[str, Any]:
    """Describe JSON of a wire type, in a body or an answer."""
    return {"schema": {"$ref": f"#/components/schemas/{kind.__name__}"}}


def form_content(parts: Mapping[str, Part]) -> dict[str, Any]:
    """Describe a form of these parts."""
    return {
        "schema": {
            "type": "object",
            "additionalProperties": False,
            "required": [name for name, part in parts.items() if part.least],
            "properties": {name: part.schema for name, part in parts.items()},
        },
        "encoding": {name: {"contentType": part.media_types} for name, part in parts.items()},
    }


def body(**content: Mapping[str, Any]) -> dict[str, Any]:
    """Describe a body for the OpenAPI document, ``json``, ``form`` or both, and its refusals."""
    kinds = {"json": JSON, "form": MULTIPART}
    described = {kinds[name]: each for name, each in content.items()}
    refusals = documented("malformed-request", "payload-too-large", "unsupported-media-type")
    return {
        "requestBody": {"required": True, "content": described},
        "responses": {str(status): each for status, each in refusals.items()},
    }


async def read_json(request: Request, kind: type[Model]) -> Received[Model]:
    """Read a JSON body as a wire type.

    Raises
    ------
    ProblemError
        If it is declared as something else, or larger than any valid request.
    RefusedError
        If it is not JSON, or not of this type.
    """
    if media_type(request) != JSON:
        raise _unsupported(request, remedy=f"Send {JSON}.", accepted=JSON)
    text = b""
    async for chunk in request.stream():
        text += chunk
        if len(text) > MAX_JSON_BYTES:
            raise problem_error(
                slug="payload-too-large",
                detail=f"The JSON exceeds {MAX_JSON_BYTES} bytes.",
                remedy="Send what /openapi.json describes for this path.",
            )
    asked = parsed(kind, text, whole="body", called="the body")
    return Received(text=text, asked=asked, files={})


async def read_json_or_form(
    request: Request, kind: type[Model], parts: Mapping[str, Part]
) -> Received[Model]:
    """Read JSON alone, or a form whose part ``request`` it is; ``{}`` if that did not come.

    Raises as :func:`read_json` and :func:`read_form` do.
    """
    if media_type(request) == JSON:
        return await read_json(request, kind)
    files = await read_form(request, parts, or_json=True)
    text = files.pop(REQUEST, [b"{}"])[0]
    asked = parsed(kind, text, whole=REQUEST, called=f"the part '{REQUEST}'")
    return Received(text=text, asked=asked, files=files)


async def read_form(
    request: Request, parts: Mapping[str, Part], *, or_json: bool = False
) -> dict[str, list[bytes]]:
    """Read the parts of a form by name, those of one name in their order.

    Raises
    ------
    ProblemError
        If the body is not a multipart form, a part is missing or unknown, or one comes more than
        once that may not. What may come several times may be too many here.
    """
    if media_type(request) != MULTIPART:
        needed = [name for name, part in parts.items() if part.least] or list(parts)
        named = " and ".join(f"'{name}'" for name in needed)
        raise _unsupported(
            request,
            remedy=f"Send {MULTIPART} with the part {named}"
            + (f", or {JSON} that names uploaded files." if or_json else "."),
            accepted=f"{MULTIPART}, {JSON}" if or_json else MULTIPART,
        )
    form = await _form(request, parts)
    try:
        _check_parts(form, parts)
        return {
            name: [await _content(part) for part in form.getlist(name)]
            for name in parts
            if name in form
        }
    finally:
        await form.close()


def media_type(request: Request) -> str:
    """Return the declared media type of the body, in lower case, without parameters."""
    return request.headers.get("content-type", "").partition(";")[0].strip().lower()


def _unsupported(request: Request, *, remedy: str, accepted: str) -> ProblemError:
    """Say that a body of this media type is not accepted here."""
    return problem_error(
        slug="unsupported-media-type",
        detail=f"The body is {shortened(media_type(request)) or 'of no declared kind'}.",
        remedy=remedy,
        headers={"Accept-Post": accepted},
    )


async def _form(request: Request, parts: Mapping[str, Part]) -> FormData:
    most = sum(part.most for part in parts.values()) + SPARE_PARTS
    try:
        form = await request.form(max_files=most, max_fields=most, max_part_size=MAX_JSON_BYTES)
    except HTTPException as error:
        raise _malformed(error.detail, parts) from error
    except UnicodeError as error:
        raise _malformed(_NO_TEXT, parts) from error
    except OSError as error:
        # Large parts are stored in the folder of temporary files until they are complete.
        if error.errno in FULL:
            raise disk_full() from error
        raise
    if not all(_is_text(text) for item in form.multi_items() for text in item):
        await form.close()
        raise _malformed(_NO_TEXT, parts)
    return form


_NO_TEXT: Final = "In the charset that it names, it is no text."


def _is_text(value: UploadFile | str) -> bool:
    """Return true if it can be encoded: some charsets can express lone surrogates."""
    if isinstance(value, str):
        try:
            value.encode()
        except UnicodeEncodeError:
            return False
    return True


def _malformed(reason: str, parts: Mapping[str, Part]) -> ProblemError:
    return problem_error(
        slug="malformed-request",
        detail=f"The multipart body cannot be read: {reason}",
        remedy=f"Send these parts and no others: {', '.join(parts)}.",
    )


def _check_parts(form: FormData, parts: Mapping[str, Part]) -> None:
    came = Counter(name for name, _ in form.multi_items())
    errors = [*_faults(came, parts)]
    if errors:
        raise ProblemError(field_problem("invalid-request", *errors))


def _faults(came: Mapping[str, int], parts: Mapping[str, Part]) -> Iterator[FieldProblem]:
    for name, part in parts.items():
        if part.least and name not in came:
            yield FieldProblem(
                field=name,
                code="missing",
                reason=f"The part '{name}' is missing.",
                remedy=f"Send a multipart part named '{name}'.",
            )
    for name, times in came.items():
        if name not in parts:
            yield FieldProblem(
                field=name,
                code="unknown-field",
                reason=f"There is no part called '{shortened(name)}'.",
                remedy=f"Parts there are: {', '.join(parts)}.",
            )
        elif times > 1 and parts[name].most == 1:
            yield FieldProblem(
                field=name,
                code="repeated-field",
                reason=f"The part '{name}' comes more than once.",
                remedy="Send it once.",
            )


async def _content(part: UploadFile | str) -> bytes:
    return part.encode() if isinstance(part, str) else await part.read()


async def check_form(request: Request) -> None:
    """Refuse query parameters that the OpenAPI document does not name, and repeated ones.

    Raises
    ------
    ProblemError
        With each parameter by its name.
    """
    if not (request.url.query and request.url.path.startswith(PREFIX)):
        return
    path = request.app.openapi()["paths"].get(request.scope["route"].path, {})
    declared = path.get(request.method.lower(), {}).get("parameters", ())
    known = [each["name"] for each in declared if each["in"] == "query"]
    counted = Counter(name for name, _ in request.query_params.multi_items())
    there = f"Parameters there are: {', '.join(known)}." if known else "This path has none."
    faults = [
        FieldProblem(
            field=name,
            code="repeated-field" if name in known else "unknown-field",
            reason="The query parameter comes more than once."
            if name in known
            else "There is no such query parameter.",
            remedy="Send it once." if name in known else f"Remove it, or correct its name. {there}",
        )
        for name, times in counted.items()
        if name not in known or times > 1
    ]
    if faults:
        raise ProblemError(field_problem("invalid-request", *faults))
