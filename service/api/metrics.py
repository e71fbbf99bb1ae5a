"""The metrics of :mod:`service.api.service_metrics`, for Prometheus to scrape."""

from typing import Final

from fastapi import APIRouter, Response
from prometheus_client.exposition import CONTENT_TYPE_LATEST

from service.api.context import Context
from service.api.problems import documented

ROUTER: Final = APIRouter(tags=["health"])


@ROUTER.get(
    "/metrics",
    summary="Figures for Prometheus",
    response_class=Response,
    responses={
        200: {
            "description": "Prometheus' text format.",
            "content": {"text/plain": {"schema": {"type": "string"}}},
        }
    }
    | documented("not-ready", "internal-error"),
)
def get_metrics(context: Context) -> Response:
    """Return queue, workers, endings, durations and requests; needs a key made for metrics."""
    return Response(context.metrics.exposition(), media_type=CONTENT_TYPE_LATEST)
