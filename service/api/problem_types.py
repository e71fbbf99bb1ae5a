"""What the ``type`` of a problem refers to."""

from typing import Annotated, Final

from fastapi import APIRouter, Path

from api_schemas.problems import PROBLEM_TYPES, ProblemType
from service.api.problems import documented, not_found

ROUTER: Final = APIRouter(prefix="/problems", tags=["problems"])


@ROUTER.get(
    "/{slug}",
    response_model=ProblemType,
    summary="What a problem type means",
    responses=documented("not-found"),
)
def get_problem_type(
    slug: Annotated[str, Path(json_schema_extra={"enum": list(PROBLEM_TYPES)})],
) -> ProblemType:
    """Describe a problem type."""
    if slug not in PROBLEM_TYPES:
        raise not_found(what="such problem type")
    return PROBLEM_TYPES[slug]
