"""Parts of files by bytes (RFC 9110 14)."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from fastapi import Response

from api_schemas.problems import problem
from service.api.problems import ProblemError


@dataclass(frozen=True, slots=True)
class ByteRange:
    """First and last byte, both included."""

    first: int
    last: int


def parse_range(header: str, size: int) -> ByteRange | None:
    """Read a Range header of one range; None if the whole file is to be sent instead.

    A header that is not understood, or asks for several ranges, is ignored (RFC 9110 14.2).

    Raises
    ------
    ValueError
        If the range lies outside the file's ``size`` bytes.
    """
    found = re.fullmatch(r"bytes=(\d{0,18})-(\d{0,18})", header.strip())
    if found is None or not (found[1] or found[2]):
        return None
    if not found[1]:
        length = min(int(found[2]), size)
        first, last = size - length, size - 1
    else:
        first = int(found[1])
        last = min(int(found[2]), size - 1) if found[2] else size - 1
        if found[2] and int(found[2]) < first:
            return None
    if first > last:
        message = f"bytes {header} of {size}"
        raise ValueError(message)
    return ByteRange(first, last)


def whole_or_part(
    content: bytes,
    *,
    media_type: str,
    headers: Mapping[str, str],
    range_header: str | None,
    if_range: str | None,
) -> Response:
    """Answer with a file, or with the requested part of it; 416 if it has no such part.

    A part is sent only if ``if_range`` names this very file, else the whole. Files are sent without
    a date, so a date in ``if_range`` never matches (RFC 9110 13.1.5).
    """
    of_another = if_range not in (None, headers["ETag"])
    wanted = None if of_another else range_header
    try:
        part = None if wanted is None else parse_range(wanted, len(content))
    except ValueError as error:
        raise ProblemError(
            problem(
                "range-not-satisfiable",
                detail=f"The file has {len(content)} bytes.",
                remedy="Ask for bytes it has.",
                field="Range",
            ),
            headers={"Content-Range": f"bytes */{len(content)}"},
        ) from error
    if part is None:
        return Response(content, media_type=media_type, headers=dict(headers))
    return Response(
        content[part.first : part.last + 1],
        status_code=206,
        media_type=media_type,
        headers=dict(headers) | {"Content-Range": f"bytes {part.first}-{part.last}/{len(content)}"},
    )
