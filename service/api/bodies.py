"""Bodies without a picture: known measurements in, the most probable body out, at once."""

import base64
from typing import Annotated, Any, Final

from fastapi import APIRouter, Header, Request, Response

from api_schemas.bodies import BodyEstimate, BodyRequest
from service.api.context import Context
from service.api.estimates import ESTIMATE_PROBLEMS
from service.api.json_bodies import JSON, json_body, json_content, read_json
from service.api.problems import documented
from service.estimates.messages import BodyTask

ROUTER: Final = APIRouter(prefix="/v1/bodies", tags=["estimates"])

GLB: Final = "model/gltf-binary"

_ANSWER: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "The most probable body; as a GLB file if `Accept` asks for one.",
        "content": {
            JSON: json_content(BodyEstimate),
            GLB: {"schema": {"type": "string", "format": "binary"}},
        },
    }
}


@ROUTER.post(
    "",
    response_class=Response,
    summary="Estimate a body from measurements",
    openapi_extra=json_body(BodyRequest),
    responses=_ANSWER | documented(*ESTIMATE_PROBLEMS),
)
async def estimate_body(
    request: Request,
    context: Context,
    # Of headers of this name OpenAPI takes the answers' media types to say enough.
    accept: Annotated[str | None, Header(include_in_schema=False)] = None,
) -> Response:
    """Return the most probable body of a gender and of any known measurements.

    With its measurements, between which values 95 % of such people lie, and the mesh if asked for:
    by `include_glb` in the JSON, by `Accept: model/gltf-binary` as the file itself.
    """
    asked = await read_json(request, BodyRequest)
    as_file = GLB in (accept or "").lower()
    found = await context.estimates.body(
        BodyTask(request=asked, with_glb=as_file or asked.include_glb)
    )
    headers = {"Cache-Control": "no-store", "Vary": "Accept"}
    if as_file:
        return Response(found.glb, media_type=GLB, headers=headers)
    estimate = found.estimate
    if asked.include_glb:
        glb = base64.b64encode(found.glb).decode()
        estimate = estimate.model_copy(update={"glb": glb})
    return Response(estimate.model_dump_json(), media_type=JSON, headers=headers)
