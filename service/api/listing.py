"""Pagination of lists: the cursor at which a page ends, and the page after it."""

import re
from collections.abc import Mapping, Sequence
from typing import Annotated, Final, Protocol, TypeVar
from urllib.parse import quote

from fastapi import Query, Response

from service.submissions.refusal import refused_field

MAX_PAGE: Final = 200

CURSOR: Final = r"^([0-9]{1,12}(?:\.[0-9]{1,9})?)-([0-9a-f-]{36}|[0-9a-f]{64})$"
"""Epoch seconds at which the last entry of a page was made, and its id: a UUID or a SHA-256."""

Limit = Annotated[int, Query(ge=1, le=MAX_PAGE)]
Cursor = Annotated[
    str | None,
    Query(description="From `next` of the page before.", json_schema_extra={"pattern": CURSOR}),
]


class _Record(Protocol):
    @property
    def id(self) -> str: ...

    @property
    def created_at(self) -> float: ...


Entry = TypeVar("Entry", bound=_Record)


def read_cursor(cursor: str | None) -> tuple[float, str] | None:
    """Return time and id of the last entry of the page before; None on the first page.

    Raises
    ------
    RefusedError
        If it is no cursor of this service.
    """
    if cursor is None:
        return None
    found = re.match(CURSOR, cursor)
    if found is None:
        raise refused_field(
            field="cursor",
            code="unknown-cursor",
            reason="This is no cursor of this service.",
            remedy="Follow 'next' of a page, or leave the cursor out.",
        )
    return float(found[1]), found[2]


def page_of(
    found: Sequence[Entry],
    response: Response,
    *,
    path: str,
    limit: int,
    filters: Mapping[str, str | None] | None = None,
) -> tuple[Sequence[Entry], str | None]:
    """Return the entries of a page and the path of the next, which the Link header names too.

    ``found`` has one entry more than the page where another one follows.
    """
    page = found[:limit]
    if len(found) <= limit:
        return page, None
    cursor = f"{page[-1].created_at!r}-{page[-1].id}"
    asked = {"limit": str(limit), "cursor": cursor, **(filters or {})}
    query = "&".join(f"{name}={quote(value, safe='')}" for name, value in asked.items() if value)
    following = f"{path}?{query}"
    response.headers["Link"] = f'<{following}>; rel="next"'
    return page, following
