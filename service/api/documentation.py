"""The documentation: the page that shows the API, and the site where it has been built.

The page is Swagger UI from our own files, with nothing inline. The site is built from
``service/docs``; a wheel does not bring it.
"""

import os
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

from fastapi import APIRouter, FastAPI, Response
from starlette.requests import Request
from starlette.responses import RedirectResponse
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from api_schemas.problems import problem
from service.api.problems import ProblemError
from service.api.security_headers import OWN_FILES, STATIC_SITE

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


PATH: Final = "/documentation"
FOLDER: Final = Path(__file__).parents[1] / "docs_site"

ABSENT: Final = "This service has no documentation site."
REMEDY: Final = (
    "`make docs` builds it from a clone, whose files in service/docs can be read as they are; the "
    "image of a release has it. Start the service again afterwards."
)


def mount_site(app: FastAPI, folder: Path = FOLDER) -> None:
    """Serve the site; where it has not been built, lead to the API or say so."""
    if not folder.is_dir():
        for path in (PATH, f"{PATH}/{{page:path}}"):
            app.add_route(path, _absent, include_in_schema=False)
        return

    def begin(_: Request) -> Response:
        return RedirectResponse(f"{PATH}/", status_code=308)

    app.add_route(PATH, begin, include_in_schema=False)
    app.mount(PATH, _Site(directory=folder, html=True))


def _absent(request: Request) -> Response:
    if "text/html" in request.headers.get("Accept", ""):
        return RedirectResponse("/docs", status_code=307)
    raise ProblemError(problem("not-found", detail=ABSENT, remedy=REMEDY))


class _Site(StaticFiles):
    def file_response(
        self,
        full_path: "os.PathLike[str] | str",
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["Content-Security-Policy"] = STATIC_SITE
        response.headers["Cache-Control"] = "no-cache"
        return response
