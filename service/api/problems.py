"""Every error leaves the service through here, as problem+json; and what its types mean."""

import logging
import re
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Annotated, Any, Final

from fastapi import APIRouter, FastAPI, Path, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import Response
from starlette.exceptions import HTTPException

from api_schemas.problems import (
    LONGEST_TEXT,
    PROBLEM_MEDIA_TYPE,
    PROBLEM_TYPES,
    Problem,
    ProblemType,
    field_problem,
    problem,
    shortened,
)
from service.jobs.blobs import BlobsUnavailableError, StorageFullError
from service.jobs.database import DAMAGE_REMEDY
from service.jobs.records import (
    EngineDamagedError,
    EngineFullError,
    EngineUnavailableError,
    JobExpiredError,
)
from service.submissions.refusal import RefusedError, field_problems

LOG: Final = logging.getLogger(__name__)

DAMAGED: Final = problem(
    "not-ready",
    code="database-damaged",
    detail="The file of the database is damaged.",
    remedy=DAMAGE_REMEDY,
)

RETRY_AFTER_S: Final = 5

RESPONSE_NAME: Final = "Problem"
RESPONSES: Final = f"#/components/responses/{RESPONSE_NAME}"


class ProblemError(Exception):
    """Raised by a resource to answer with a problem."""

    def __init__(self, reason: Problem, *, headers: Mapping[str, str] | None = None) -> None:
        super().__init__(reason.detail)
        self.problem = reason
        self.headers = dict(headers or {})


def problem_error(
    *,
    slug: str,
    detail: str,
    remedy: str,
    code: str | None = None,
    field: str | None = None,
    headers: Mapping[str, str] | None = None,
) -> ProblemError:
    """Build a problem to raise; as :func:`api_schemas.problems.problem`."""
    return ProblemError(
        problem(slug, detail=detail, remedy=remedy, code=code, field=field), headers=headers
    )


def not_found(*, what: str) -> ProblemError:
    """Say that something does not exist."""
    return problem_error(
        slug="not-found",
        detail=f"There is no {what}.",
        remedy="Check the address; erased jobs are not found any more.",
    )


def documented(*slugs: str) -> dict[int | str, dict[str, Any]]:
    """Refer to the problems an operation may answer with, for the OpenAPI document."""
    return {
        status: {"$ref": f"{RESPONSES}{status}"}
        for status in dict.fromkeys(PROBLEM_TYPES[slug].status for slug in slugs)
    }


def documented_responses(paths: str) -> dict[str, dict[str, Any]]:
    """Describe what :func:`documented` refers to, so far as the document's ``paths`` do.

    There is one for each status, which names the problems that have it.
    """
    titles: dict[int, list[str]] = {}
    for each in PROBLEM_TYPES.values():
        titles.setdefault(each.status, []).append(each.title)
    content = {PROBLEM_MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    return {
        f"{RESPONSE_NAME}{status}": {"description": "; ".join(found), "content": content}
        for status, found in sorted(titles.items())
        if f'"{RESPONSES}{status}"' in paths
    }


def problem_response(
    request: Request, reason: Problem, headers: Mapping[str, str] | None = None
) -> Response:
    """Answer with a problem, and when to try again where that is the remedy."""
    later = {"Retry-After": str(RETRY_AFTER_S)}
    located = reason.model_copy(update={"instance": shortened(request.url.path, LONGEST_TEXT)})
    return Response(
        located.model_dump_json(),
        status_code=reason.status,
        media_type=PROBLEM_MEDIA_TYPE,
        headers={**(later if reason.status in (429, 503) else {}), **(headers or {})},
    )


def install_problem_handlers(app: FastAPI) -> None:
    """Make exceptions of resources problems; :mod:`service.api.observation` does so with faults."""
    app.add_exception_handler(ProblemError, _on_problem)
    app.add_exception_handler(RefusedError, _on_problem)
    app.add_exception_handler(RequestValidationError, _on_validation)
    app.add_exception_handler(HTTPException, _on_http)
    app.add_exception_handler(EngineUnavailableError, unavailable)
    app.add_exception_handler(BlobsUnavailableError, unavailable)
    app.add_exception_handler(JobExpiredError, _on_expired)


def _on_problem(request: Request, error: Exception) -> Response:
    assert isinstance(error, ProblemError | RefusedError)
    return problem_response(request, error.problem, getattr(error, "headers", None))


def _on_validation(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    errors, further = field_problems(error.errors())
    reason = field_problem("invalid-request", *errors, further=further)
    return problem_response(request, reason)


def _on_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    if error.status_code == 404:
        return problem_response(request, not_found(what="such path").problem)
    if error.status_code == 405:
        allowed = ", ".join(_allowed_methods(request))
        reason = problem(
            "method-not-allowed",
            detail=f"{request.method} is not offered here.",
            remedy=f"Use one of: {allowed}.",
        )
        return problem_response(request, reason, {"Allow": allowed})
    slug = "malformed-request" if error.status_code < 500 else "internal-error"
    reason = problem(
        slug, detail=str(error.detail), remedy="Send what /openapi.json describes for this path."
    )
    return problem_response(request, reason, error.headers)


def unavailable(request: Request, error: Exception) -> Response:
    """Answer that database or storage is away, full, or damaged."""
    if isinstance(error, EngineDamagedError):
        # The log has it from where it was found.
        return problem_response(request, DAMAGED)
    what = "database" if isinstance(error, EngineUnavailableError) else "storage"
    is_full = isinstance(error, EngineFullError | StorageFullError)
    # A line, not a trace: in an outage every request comes through here.
    LOG.error(
        "%s %s: the %s is %s (%s).",
        request.method,
        request.url.path,
        what,
        "full" if is_full else "away",
        _drivers_words(error),
    )
    reason = problem(
        "not-ready",
        code="disk-full" if is_full else f"{what}-unavailable",
        detail=f"The {what} is {'full' if is_full else 'not available'}.",
        remedy="Try again after the time in Retry-After; nothing was changed.",
    )
    return problem_response(request, reason)


def _drivers_words(error: Exception) -> str:
    """The words of the driver, in one line and without the statement."""
    cause = error.__cause__ or error
    return " ".join(str(getattr(cause, "orig", cause)).split())


def _on_expired(request: Request, error: Exception) -> Response:
    assert isinstance(error, JobExpiredError)
    moment = datetime.fromtimestamp(error.expired_at, UTC).isoformat(timespec="seconds")
    reason = problem(
        "fit-expired",
        detail=f"The job's time was over at {moment}; its picture and results are erased.",
        remedy="Post the picture again.",
    )
    return problem_response(request, reason)


def _allowed_methods(request: Request) -> list[str]:
    # Starlette names only the methods of a path's first route; the document has all of them.
    allowed: set[str] = set()
    for template, operations in request.app.openapi()["paths"].items():
        pattern = re.sub(r"\\\{\w+\\\}", "[^/]+", re.escape(template))
        if re.fullmatch(pattern, request.url.path):
            allowed |= {method.upper() for method in operations}
    if "GET" in allowed or not allowed:
        allowed |= {"GET", "HEAD"}
    return sorted(allowed)


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
