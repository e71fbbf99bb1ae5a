"""A sample of every type of problem, as this service says it."""

from collections.abc import Mapping
from typing import Final

from api_schemas.problems import FieldProblem, Problem, field_problem, problem

_SAMPLES: Final = (
    problem(
        "malformed-request",
        code="invalid-json",
        detail="The request is not JSON: Invalid JSON: expected `,` or `}` at line 1 column 19.",
        remedy="Send well-formed JSON.",
        field="request",
    ),
    problem(
        "unauthorized",
        detail="The API key is unknown or revoked.",
        remedy="Send the header 'Authorization: Bearer' with a key; whoever runs the service "
        "makes one with: maquette keys create TENANT",
        field="Authorization",
    ),
    problem(
        "forbidden",
        code="wrong-role",
        detail="This key is for metrics only.",
        remedy="Use a key made for this purpose.",
        field="Authorization",
    ),
    problem(
        "not-found",
        detail="There is no such job.",
        remedy="Check the address; erased jobs are not found any more.",
    ),
    problem(
        "method-not-allowed",
        detail="PUT is not offered here.",
        remedy="Use one of: GET, POST.",
    ),
    problem(
        "not-acceptable",
        detail="body_posed.glb cannot be had as model/fbx.",
        remedy="Ask for one of model/gltf-binary, model/obj, model/ply, model/stl, or leave the "
        "header out.",
        field="Accept",
    ),
    problem(
        "request-timeout",
        code="body-too-slow",
        detail="Of the body 48000 bytes came in 42 s.",
        remedy="Send it within 30 s, and a second more for each 4000 bytes; a smaller picture "
        "takes less.",
    ),
    problem(
        "no-result",
        detail="The job is running.",
        remedy="Wait until it has succeeded; follow its events.",
    ),
    problem(
        "not-ended",
        detail="The job is running.",
        remedy="Wait for its end, or cancel it first.",
    ),
    problem(
        "fit-expired",
        detail="The job's time was over at 2026-05-11T09:30:05+00:00; its picture and results are "
        "erased.",
        remedy="Post the picture again.",
    ),
    problem(
        "payload-too-large",
        detail="The body exceeds 52000000 bytes.",
        remedy="Send the picture as JPEG, or scale it down; 1500 pixels are plenty.",
    ),
    field_problem(
        "unsupported-media-type",
        FieldProblem(
            field="image",
            code="not-an-image",
            reason="The upload is not a JPEG, PNG, WebP or HEIC file.",
            remedy="Send a JPEG, PNG, WebP or HEIC file.",
        ),
    ),
    problem(
        "range-not-satisfiable",
        detail="The file has 1893204 bytes.",
        remedy="Ask for bytes it has.",
        field="Range",
    ),
    field_problem(
        "invalid-request",
        FieldProblem(
            field="height_m",
            code="out-of-range",
            reason="Input should be less than or equal to 2.3.",
            remedy="Send a number at most 2.3.",
        ),
        FieldProblem(
            field="gender",
            code="missing",
            reason="Field required.",
            remedy="Send this field.",
        ),
    ),
    field_problem(
        "unusable-input",
        FieldProblem(
            field="image",
            code="image-damaged",
            reason="The file is damaged: image file is truncated.",
            remedy="Send the whole file, or save the picture anew.",
        ),
    ),
    problem(
        "idempotency-key-reused",
        detail="This Idempotency-Key came earlier with another request.",
        remedy="Use a new key for every new request.",
        field="Idempotency-Key",
    ),
    problem(
        "too-many-requests",
        code="rate-limit",
        detail="This key asks too often.",
        remedy="Wait for the seconds in Retry-After; follow events instead of polling.",
    ),
    problem(
        "fit-failed",
        detail="An unexpected fault ended the job.",
        remedy="Report it with the job's id; other jobs are not affected.",
    ),
    problem(
        "fit-crashed",
        detail="The process that fitted this picture died three times.",
        remedy="Save the picture anew as PNG and try again; if that fails too, report it.",
    ),
    problem(
        "internal-error",
        detail="An unexpected fault; it has been logged.",
        remedy="Try again later.",
    ),
    problem(
        "queue-full",
        detail="The queue of waiting jobs is full.",
        remedy="Try again after the time in Retry-After.",
    ),
    problem(
        "not-ready",
        code="database-unavailable",
        detail="The database of jobs is not available.",
        remedy="Try again after the time in Retry-After; nothing was changed.",
    ),
    problem(
        "too-many-connections",
        detail="All connections that this service allows are busy.",
        remedy="Try again after the time in Retry-After, and keep fewer connections open.",
    ),
    problem(
        "time-limit-exceeded",
        detail="The job was stopped after 600 s.",
        remedy="Send a smaller picture, choose the optimizer gauss_newton, or ask for less.",
    ),
    problem(
        "insufficient-storage",
        code="disk-full",
        detail="Too little of the disk is free; nothing was kept.",
        remedy="Erase what you need no more by DELETE, or try again after the time in Retry-After.",
    ),
    problem(
        "quota-exceeded",
        detail="1000 pictures of 412345678 bytes are kept for you; at most 1000 pictures and "
        "5000000000 bytes may be.",
        remedy="Erase pictures you need no more by DELETE /v1/images/{id}, or wait until they "
        "expire; a fit can also bring its picture along.",
    ),
)

PROBLEM_SAMPLES: Final[Mapping[str, Problem]] = {
    sample.type.removeprefix("/problems/"): sample for sample in _SAMPLES
}
"""By type."""
