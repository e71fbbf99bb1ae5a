"""A request that is well-formed HTTP and still cannot be accepted."""

from api_schemas.problems import FieldProblem, Problem, field_problem


class RefusedError(Exception):
    """Carries the problem to answer with."""

    def __init__(self, reason: Problem) -> None:
        super().__init__(reason.detail)
        self.problem = reason


def refused(*errors: FieldProblem, slug: str = "invalid-request") -> RefusedError:
    """Refuse for one or more fields."""
    return RefusedError(field_problem(slug, *errors))
