"""The documentation site (``service/docs``), which an image brings with it and a wheel does not."""

import os
from pathlib import Path
from typing import Final

from fastapi import FastAPI
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from api_schemas.problems import problem
from service.api.problems import ProblemError
from service.api.security_headers import STATIC_SITE

PATH: Final = "/documentation"
FOLDER: Final = Path(__file__).parents[1] / "docs_site"

ABSENT: Final = "This service was installed without its documentation."
REMEDY: Final = (
    "The image of a release has it, a release's archive of it can be unpacked beside the service, "
    "and `make docs` builds it from the sources. Start the service again afterwards."
)


def mount(app: FastAPI, folder: Path = FOLDER) -> None:
    """Serve the site; where there is none, say how to get it."""
    if not folder.is_dir():
        for path in (PATH, f"{PATH}/{{page:path}}"):
            app.add_route(path, _absent, include_in_schema=False)
        return

    def begin(_: Request) -> Response:
        return RedirectResponse(f"{PATH}/", status_code=308)

    app.add_route(PATH, begin, include_in_schema=False)
    app.mount(PATH, _Site(directory=folder, html=True))


def _absent(_: Request) -> Response:
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
