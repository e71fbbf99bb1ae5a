"""Errors as RFC 9457 problem details, and the list of all types there are."""

from collections.abc import Mapping
from typing import Final

from pydantic import Field

from api_schemas.base import WireModel

PROBLEM_MEDIA_TYPE: Final = "application/problem+json"

MOST_ERRORS: Final = 10
"""Largest number of errors that a problem names."""

LONGEST_NAME: Final = 100
"""Largest number of characters of a caller's words that a problem repeats."""

LONGEST_TEXT: Final = 1_000
""""Use 'nose', 'left_eye', ..." names all points."""


class FieldProblem(WireModel):
    """Problem with one field: what is wrong, why, and what to do."""

    field: str
    code: str
    reason: str
    remedy: str
    largest: float | None = Field(
        default=None,
        description="The largest value that can be used, where a smaller one can be.",
    )


class Problem(WireModel):
    """An error. ``type`` is a relative reference to its description below this service's root.

    ``field``, ``code`` and ``remedy`` repeat the first of ``errors``, or speak of the request as a
    whole when no single field is at fault.
    """

    type: str = Field(examples=["/problems/invalid-request"])
    title: str
    status: int = Field(ge=400, le=599)
    detail: str
    code: str = Field(description="Stable, kebab-case.", examples=["out-of-range"])
    remedy: str
    field: str | None = Field(default=None, examples=["height_m"])
    instance: str | None = None
    errors: tuple[FieldProblem, ...] = ()


class ProblemType(WireModel):
    """A kind of problem, as ``GET /problems/{slug}`` describes it."""

    slug: str
    title: str
    status: int
    description: str


_TYPES: Final = (
    ProblemType(
        slug="malformed-request",
        title="The request cannot be read",
        status=400,
        description="The body is not well-formed multipart data, or its JSON part is not JSON.",
    ),
    ProblemType(
        slug="unauthorized",
        title="An API key is needed",
        status=401,
        description="There is no API key in the Authorization header, or it is not in use.",
    ),
    ProblemType(
        slug="forbidden",
        title="This may not be asked from here",
        status=403,
        description="The API key is for something else, or the request comes from a foreign page.",
    ),
    ProblemType(
        slug="not-found",
        title="There is nothing here",
        status=404,
        description=(
            "No such path, job, file, picture or problem type; erased jobs are not found."
        ),
    ),
    ProblemType(
        slug="method-not-allowed",
        title="This method is not offered here",
        status=405,
        description="The path exists but takes other methods; the Allow header lists them.",
    ),
    ProblemType(
        slug="request-timeout",
        title="The request came too slowly",
        status=408,
        description="The body of the request was not whole in time.",
    ),
    ProblemType(
        slug="no-result",
        title="The job has no result",
        status=409,
        description="The job has not ended yet, or ended without a result; its status says which.",
    ),
    ProblemType(
        slug="not-ended",
        title="The job has not ended",
        status=409,
        description="What was asked for is possible only once the job has ended.",
    ),
    ProblemType(
        slug="fit-expired",
        title="The job has expired",
        status=410,
        description="Its picture and results were erased at the end of their retention.",
    ),
    ProblemType(
        slug="payload-too-large",
        title="The upload is too large",
        status=413,
        description="The body exceeds the size this service accepts.",
    ),
    ProblemType(
        slug="unsupported-media-type",
        title="This kind of content is not accepted",
        status=415,
        description="The body is of another kind, or a picture is not JPEG, PNG, WebP or HEIC.",
    ),
    ProblemType(
        slug="invalid-request",
        title="The request is not valid",
        status=422,
        description="A field is missing, unknown, of the wrong kind or out of range; see errors.",
    ),
    ProblemType(
        slug="unusable-input",
        title="What was sent cannot be used",
        status=422,
        description=(
            "Picture, mask, points or measurements are well-formed, but no body follows from them."
        ),
    ),
    ProblemType(
        slug="idempotency-key-reused",
        title="The idempotency key belongs to another request",
        status=422,
        description="The same Idempotency-Key came earlier with another picture or other options.",
    ),
    ProblemType(
        slug="too-many-requests",
        title="Too much at once",
        status=429,
        description="This API key asks too often, or too many of its jobs are waiting.",
    ),
    ProblemType(
        slug="fit-failed",
        title="The fit failed",
        status=500,
        description="A fault of this service, not of the input; it has been logged.",
    ),
    ProblemType(
        slug="fit-crashed",
        title="The fit crashed repeatedly",
        status=500,
        description="The process fitting this picture died at every attempt; it was given up.",
    ),
    ProblemType(
        slug="internal-error",
        title="The service failed",
        status=500,
        description="An unexpected fault while answering; it has been logged.",
    ),
    ProblemType(
        slug="queue-full",
        title="The queue is full",
        status=503,
        description="Too many jobs are waiting; try again after the time in Retry-After.",
    ),
    ProblemType(
        slug="not-ready",
        title="The service is not ready",
        status=503,
        description="The database, the disk or the workers are not available at the moment.",
    ),
    ProblemType(
        slug="too-many-connections",
        title="All connections are busy",
        status=503,
        description="Too many clients are connected; try again after the time in Retry-After.",
    ),
    ProblemType(
        slug="time-limit-exceeded",
        title="The fit took too long",
        status=504,
        description="The fit was stopped at this service's time limit.",
    ),
    ProblemType(
        slug="insufficient-storage",
        title="There is no room on the disk",
        status=507,
        description=(
            "Less of the service's disk is free than it keeps for what runs: nothing new is stored "
            "until room is made. What is stored can be read and erased."
        ),
    ),
    ProblemType(
        slug="quota-exceeded",
        title="There is no room for more of your pictures",
        status=507,
        description=(
            "As many uploaded pictures, or bytes of them, are kept as one tenant may have."
        ),
    ),
)

PROBLEM_TYPES: Final[Mapping[str, ProblemType]] = {kind.slug: kind for kind in _TYPES}


def problem(
    slug: str,
    *,
    detail: str,
    remedy: str,
    code: str | None = None,
    field: str | None = None,
    errors: tuple[FieldProblem, ...] = (),
) -> Problem:
    """Build a problem of a listed type; ``code`` is the type's own name unless given."""
    kind = PROBLEM_TYPES[slug]
    return Problem(
        type=f"/problems/{slug}",
        title=kind.title,
        status=kind.status,
        detail=detail,
        code=code or slug,
        remedy=remedy,
        field=field,
        errors=errors,
    )


def field_problem(slug: str, *errors: FieldProblem, further: int = 0) -> Problem:
    """Build a problem about one or more fields, led by the first.

    Ten at most are named, however many a caller got wrong; ``further`` are not among ``errors``.
    """
    named = tuple(_shortened(error) for error in errors[:MOST_ERRORS])
    further += len(errors) - len(named)
    details = [f"{error.field}: {error.reason}" for error in named]
    if further:
        details.append(f"{further} more are at fault.")
    first = named[0]
    return problem(
        slug,
        detail=" ".join(details),
        remedy=first.remedy,
        code=first.code,
        field=first.field,
        errors=named,
    )


def shortened(text: str, most: int = LONGEST_NAME) -> str:
    """A caller's words as far as they are repeated."""
    return text if len(text) <= most else f"{text[:most]}..."


def _shortened(error: FieldProblem) -> FieldProblem:
    cut = {
        "field": shortened(error.field),
        "reason": shortened(error.reason, LONGEST_TEXT),
        "remedy": shortened(error.remedy, LONGEST_TEXT),
    }
    return error.model_copy(update=cut)
