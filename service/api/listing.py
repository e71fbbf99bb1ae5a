"""Pagination of lists: the cursor at which a page ends, and the page after it."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, Final, TypeVar
from urllib.parse import quote

from fastapi import Query, Response

from api_schemas.problems import FieldProblem, field_problem
from service.api.problems import ProblemError

Entry = TypeVar("Entry")

MAX_PAGE: Final = 200

MOMENT: Final = r"[0-9]{1,12}(?:\.[0-9]{1,9})?"
"""Epoch seconds."""

Limit = Annotated[int, Query(ge=1, le=MAX_PAGE)]


def cursor_pattern(identity: str) -> str:
    """The pattern of cursors of a list whose entries have ids of this pattern."""
    return f"^({MOMENT})-({identity})$"


def cursor_query(pattern: str) -> Any:
    """Describe the query parameter with a cursor of this pattern."""
    return Query(
        description="From `next` of the page before.", json_schema_extra={"pattern": pattern}
    )


def cursor_of(created_at: float, identity: str) -> str:
    """The cursor of the page that ends with an entry."""
    return f"{created_at!r}-{identity}"


def read_cursor(pattern: str, cursor: str | None) -> tuple[float, str] | None:
    """When the last entry of the page before was made, and its id; None on the first page.

    Raises
    ------
    ProblemError
        If it is no cursor of such a list.
    """
    if cursor is None:
        return None
    found = re.fullmatch(pattern.removeprefix("^").removesuffix("$"), cursor)
    if found is None:
        raise ProblemError(
            field_problem(
                "invalid-request",
                FieldProblem(
                    field="cursor",
                    code="unknown-cursor",
                    reason="This is no cursor of this service.",
                    remedy="Follow 'next' of a page, or leave the cursor out.",
                ),
            )
        )
    return float(found[1]), found[2]


def page_of(
    found: Sequence[Entry],
    response: Response,
    *,
    path: str,
    limit: int,
    cursor: Callable[[Entry], str],
    filters: Mapping[str, str | None] | None = None,
) -> tuple[Sequence[Entry], str | None]:
    """Return the entries of a page and the path of the next, which the Link header names too.

    ``found`` has one entry more than the page where another one follows.
    """
    page = found[:limit]
    if len(found) <= limit:
        return page, None
    asked = {"limit": str(limit), "cursor": cursor(page[-1]), **(filters or {})}
    query = "&".join(f"{name}={quote(value, safe='')}" for name, value in asked.items() if value)
    following = f"{path}?{query}"
    response.headers["Link"] = f'<{following}>; rel="next"'
    return page, following
