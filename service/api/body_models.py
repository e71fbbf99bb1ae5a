"""The bodies this service fits with."""

from typing import Final

from fastapi import APIRouter

from api_schemas.body_models import BodyModels
from api_schemas.problems import problem
from service.api.context import Context
from service.api.problems import ProblemError, documented

ROUTER: Final = APIRouter(prefix="/v1/body-models", tags=["body models"])


@ROUTER.get(
    "",
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
