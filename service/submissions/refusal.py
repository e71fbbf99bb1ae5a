"""A request that is well-formed HTTP and still cannot be accepted."""

import contextlib
from collections.abc import Iterator

from api_schemas.problems import FieldProblem, Problem, field_problem


class RefusedError(Exception):
    """Carries the problem to answer with."""

    def __init__(self, reason: Problem) -> None:
        super().__init__(reason.detail)
        self.problem = reason


@contextlib.contextmanager
def of_view(number: int) -> Iterator[None]:
    """Let fields that are refused begin with the view they belong to."""
    try:
        yield
    except RefusedError as error:
        told = error.problem
        if not told.errors:
            raise
        named = [
            each.model_copy(update={"field": f"views.{number}.{each.field}"})
            for each in told.errors
        ]
        slug = told.type.rpartition("/")[2]
        raise RefusedError(field_problem(slug, *named)) from error


def refused(*errors: FieldProblem, slug: str = "invalid-request") -> RefusedError:
    """Refuse for one or more fields."""
    return RefusedError(field_problem(slug, *errors))
