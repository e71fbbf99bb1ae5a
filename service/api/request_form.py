"""Refuse unknown query parameters and compressed bodies, whatever the operation.

The parameters of an operation are read from the OpenAPI document, and only if there are any to
check.
"""

from collections import Counter
from typing import Any, Final

from fastapi import Request

from api_schemas.problems import FieldProblem, field_problem, problem
from service.api.problems import ProblemError

PREFIX: Final = "/v1/"
"""Probes and scrapes of metrics are not kept from their answer by what a monitor adds to them."""

MOST_NAMED: Final = 10
LONGEST_NAME: Final = 80


async def check_form(request: Request) -> None:
    """Refuse unknown and repeated query parameters, and bodies that are compressed.

    Raises
    ------
    ProblemError
        With each parameter by its name.
    """
    if not request.url.path.startswith(PREFIX):
        return
    if request.url.query:
        _check_parameters(request)
    coding = request.headers.get("content-encoding", "identity").strip().lower()
    if coding not in ("", "identity") and "requestBody" in _operation(request):
        raise _encoded(coding)


def _check_parameters(request: Request) -> None:
    shared = request.app.openapi()["components"].get("parameters", {})
    declared = [
        shared[each["$ref"].rpartition("/")[2]] if "$ref" in each else each
        for each in _operation(request).get("parameters", ())
    ]
    known = [each["name"] for each in declared if each["in"] == "query"]
    counted = Counter(name for name, _ in request.query_params.multi_items())
    there = f"Parameters there are: {', '.join(known)}." if known else "This path has none."
    faults = [
        FieldProblem(
            field=name[:LONGEST_NAME],
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
        raise ProblemError(field_problem("invalid-request", *faults[:MOST_NAMED]))


def _encoded(coding: str) -> ProblemError:
    return ProblemError(
        problem(
            "unsupported-media-type",
            code="encoded-body",
            field="Content-Encoding",
            detail=f"The body is said to be encoded ({coding[:LONGEST_NAME]}); it is read as it "
            "comes.",
            remedy="Send the body without Content-Encoding; pictures are compressed already.",
        ),
        # RFC 9110, 15.5.16: so a client knows that the kind of the body is not at fault.
        headers={"Accept-Encoding": "identity"},
    )


def _operation(request: Request) -> dict[str, Any]:
    """What the OpenAPI document says of the operation that was asked for."""
    path = request.app.openapi()["paths"].get(request.scope["route"].path, {})
    return path.get(request.method.lower(), {})
