"""The page that shows the API: Swagger UI from our own files, with nothing inline."""

from functools import cache
from importlib.resources import files
from typing import Final

from fastapi import APIRouter, Response

from service.api.security_headers import OWN_FILES

ROUTER: Final = APIRouter(prefix="/docs", include_in_schema=False)

PAGE: Final = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Maquette: the API</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="/docs/swagger-ui.css">
<div id="api"></div>
<script src="/docs/swagger-ui-bundle.js"></script>
<script src="/docs/start.js"></script>
</html>
"""

START: Final = """SwaggerUIBundle({
  url: "/openapi.json",
  dom_id: "#api",
  deepLinking: true,
  displayRequestDuration: true,
  persistAuthorization: false,
  validatorUrl: null,
});
"""

_PAGE_HEADERS: Final = {"Content-Security-Policy": OWN_FILES}
_FILE_HEADERS: Final = {"Cache-Control": "public, max-age=86400"}


@cache
def _file(name: str) -> bytes:
    return (files("fastapi_swagger") / "resources" / name).read_bytes()


@ROUTER.get("")
def page() -> Response:
    """Return the page."""
    return Response(PAGE, media_type="text/html", headers=_PAGE_HEADERS)


@ROUTER.get("/start.js")
def start() -> Response:
    """Return what starts Swagger UI."""
    return Response(START, media_type="text/javascript", headers=_FILE_HEADERS)


@ROUTER.get("/swagger-ui-bundle.js")
def script() -> Response:
    """Return Swagger UI."""
    return Response(
        _file("swagger-ui-bundle.js"), media_type="text/javascript", headers=_FILE_HEADERS
    )


@ROUTER.get("/swagger-ui.css")
def style() -> Response:
    """Return its style."""
    return Response(_file("swagger-ui.css"), media_type="text/css", headers=_FILE_HEADERS)
