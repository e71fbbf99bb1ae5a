"""The results of a fit: the result document and its files."""

from typing import Final
from uuid import UUID

from fastapi import APIRouter, Response

from api_schemas.jobs import JobState
from api_schemas.problems import Problem, problem
from api_schemas.results import FitResult
from service.api.artifacts import (
    NEGOTIATION,
    AcceptHeader,
    ArtifactName,
    IfRange,
    RangeHeader,
    answer_artifact,
    file_answers,
    file_headers,
    is_known,
    stored_content,
)
from service.api.context import ApiContext, Context
from service.api.job_routes import JOB_PROBLEMS, NOT_MODIFIED, IfNoneMatch, find
from service.api.problems import ProblemError, documented
from service.engine.port import JobRecord
from service.jobs.inputs import RESULT

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["results"])


@ROUTER.get(
    "/{fit_id}/result",
    summary="The result document",
    responses={200: {"model": FitResult}} | NOT_MODIFIED | documented("no-result", *JOB_PROBLEMS),
)
def result(fit_id: UUID, context: Context, if_none_match: IfNoneMatch = None) -> Response:
    """Return camera, pose, shape, light, measurements, what was assumed, and the files' names."""
    return serve_result(context, find(context.jobs, fit_id), if_none_match=if_none_match)


@ROUTER.get(
    "/{fit_id}/artifacts/{name}",
    summary="A file of the result",
    description="Return a file: `body_posed.glb`, `overlay.png` and so on, as the job's links "
    f"name them, or `body_posed.obj`, `measurements.csv` and so on.{NEGOTIATION}",
    response_class=Response,
    responses=file_answers("image/png", "application/zip"),
)
async def artifact(
    fit_id: UUID,
    name: ArtifactName,
    context: Context,
    if_none_match: IfNoneMatch = None,
    range_header: RangeHeader = None,
    if_range: IfRange = None,
    accept: AcceptHeader = None,
) -> Response:
    """Return a file, a part of it, or the same mesh in another format."""
    return await answer_artifact(
        context,
        context.jobs,
        fit_id,
        name,
        accept=accept,
        range_header=range_header,
        if_range=if_range,
        if_none_match=if_none_match,
    )


def serve_result(context: ApiContext, record: JobRecord, *, if_none_match: str | None) -> Response:
    """Answer with the result document; 409 if the job has none."""
    document = next((each for each in record.artifacts if each.name == RESULT), None)
    if record.state is not JobState.SUCCEEDED or document is None:
        raise ProblemError(no_result(record))
    headers = file_headers(document.sha256)
    if is_known(document.sha256, if_none_match):
        return Response(status_code=304, headers=headers)
    content = stored_content(context, record, document)
    return Response(content, media_type=document.media_type, headers=headers)


def no_result(record: JobRecord) -> Problem:
    """Say why a job has no result."""
    if record.problem is not None:
        return problem(
            "no-result",
            code=record.problem.code,
            field=record.problem.field,
            detail=f"The job {record.state}: {record.problem.detail}",
            remedy=record.problem.remedy,
        )
    canceled = record.state is JobState.CANCELED
    return problem(
        "no-result",
        detail=f"The job is {record.state}.",
        remedy="Send it again." if canceled else "Wait until it has succeeded; follow its events.",
    )
