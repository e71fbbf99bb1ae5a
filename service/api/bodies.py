"""Bodies without a picture: the most probable one for known measurements, and the models."""

import base64
from typing import Any, Final

from fastapi import APIRouter, Request, Response

from api_schemas.problems import problem
from api_schemas.questions import BodyEstimate, BodyRequest
from api_schemas.service import BodyModels
from service.api.context import Context
from service.api.estimates import ESTIMATE_PROBLEMS
from service.api.files import BINARY, AcceptHeader
from service.api.json_bodies import JSON, json_body, json_content, read_json
from service.api.negotiation import not_acceptable, preferred
from service.api.problems import ProblemError, documented
from service.estimates.questions import BodyTask
from service.representation.csv_tables import CSV, measurements_csv
from service.representation.formats import GLB, MESH_FORMATS

ROUTER: Final = APIRouter()

_BY_MEDIA_TYPE: Final = {each.media_type: each for each in MESH_FORMATS.values()}
_ANSWER: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "The most probable body; as a file if `Accept` asks for one.",
        "content": {
            JSON: json_content(BodyEstimate),
            **dict.fromkeys((GLB, *_BY_MEDIA_TYPE, CSV), BINARY),
        },
    }
}


@ROUTER.post(
    "/v1/bodies",
    tags=["estimates"],
    response_class=Response,
    summary="Estimate a body from measurements",
    openapi_extra=json_body(BodyRequest),
    responses=_ANSWER | documented("not-acceptable", *ESTIMATE_PROBLEMS),
)
async def estimate_body(
    request: Request,
    context: Context,
    accept: AcceptHeader = None,
) -> Response:
    """Return the most probable body of a gender and of any known measurements.

    With its measurements, between which values 95 % of such people lie, and the mesh if asked for:
    by `include_glb` in the JSON, by `Accept: model/gltf-binary`, `model/obj`, `model/ply` or
    `model/stl` as the file itself. `Accept: text/csv` answers with the
    measurements as a table. Of types wanted alike the one named first counts.
    """
    offered = (JSON, GLB, *(each.media_type for each in MESH_FORMATS.values()), CSV)
    wanted = preferred(accept, offered)
    if wanted is None:
        raise not_acceptable(accept, what="A body", offered=offered)
    asked = await read_json(request, BodyRequest)
    as_mesh = wanted == GLB or wanted in _BY_MEDIA_TYPE
    found = await context.estimates.body(
        BodyTask(request=asked, with_glb=as_mesh or (asked.include_glb and wanted == JSON))
    )
    headers = {"Cache-Control": "no-store", "Vary": "Accept"}
    estimate = found.estimate
    if wanted == CSV:
        table = measurements_csv(estimate.measurements)
        return Response(table, media_type=CSV, headers=headers)
    if wanted == GLB:
        return Response(found.glb, media_type=GLB, headers=headers)
    if as_mesh:
        mesh = await context.estimates.convert(found.glb, _BY_MEDIA_TYPE[wanted])
        return Response(mesh, media_type=wanted, headers=headers)
    if asked.include_glb:
        glb = base64.b64encode(found.glb).decode()
        estimate = estimate.model_copy(update={"glb": glb})
    return Response(estimate.model_dump_json(), media_type=JSON, headers=headers)


@ROUTER.get(
    "/v1/body-models",
    tags=["body models"],
    response_model=BodyModels,
    summary="The bodies there are",
    responses=documented("invalid-request", "not-ready", "internal-error"),
)
def list_body_models(context: Context) -> BodyModels:
    """Return genders, mean heights, landmarks, accepted points, versions and provenance."""
    known = context.engine.body_models()
    if known is None:
        raise ProblemError(
            problem(
                "not-ready",
                detail="No worker has started yet, and only workers know the bodies.",
                remedy="Start a worker, or try again in a moment.",
            )
        )
    return known
