"""Where a page of a list ends, as its caller brings it back: when and which its last entry is."""

import re
from typing import Final

from api_schemas.problems import FieldProblem, field_problem
from service.api.problems import ProblemError

MOMENT: Final = r"[0-9]{1,12}(?:\.[0-9]{1,9})?"
"""Epoch seconds."""


def cursor_pattern(identity: str) -> str:
    """The pattern of cursors of a list whose entries have ids of this pattern."""
    return f"^({MOMENT})-({identity})$"


def cursor_of(created_at: float, identity: str) -> str:
    """The cursor of the page that ends with an entry."""
    return f"{created_at!r}-{identity}"


def read_cursor(pattern: str, cursor: str) -> tuple[float, str]:
    """When the last entry of the page before was made, and its id.

    Raises
    ------
    ProblemError
        If it is no cursor of such a list.
    """
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
