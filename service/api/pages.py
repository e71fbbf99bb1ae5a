"""Pages for browsers: the page at ``/``, Swagger UI, and the documentation site if it was built.

The page is built in advance (``service/page``), the site from ``service/docs``; a wheel does not
bring the site. Swagger UI comes from our own files, with nothing inline.
"""

import mimetypes
import os
from pathlib import Path
from typing import Annotated, Final

from fastapi import APIRouter, FastAPI, Header, Request, Response
from fastapi.responses import FileResponse, RedirectResponse
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from api_schemas.service import ServiceIndex
from service.api.context import Parts
from service.api.headers import OWN_CAMERA, OWN_FILES, STATIC_SITE

ROUTER: Final = APIRouter(include_in_schema=False)

LINKS: Final = {
    "fits": "/v1/fits",
    "images": "/v1/images",
    "initial_poses": "/v1/initial-poses",
    "points": "/v1/points",
    "bodies": "/v1/bodies",
    "body_models": "/v1/body-models",
    "openapi": "/openapi.json",
    "docs": "/docs",
    "ready": "/healthz/ready",
}

SERVICE: Final = Path(__file__).parents[1]
PAGE: Final = SERVICE / "page" / "dist"
SITE: Final = SERVICE / "docs_site"

SAMPLES: Final = {
    name: SERVICE / "demo_data" / file
    for name, file in {
        "sample.json": "request.json",
        **{
            name: name
            for name in (
                *("sample.jpg", "woman.jpg", "woman.json", "arm_across.jpg", "arm_across.json"),
                *("front.jpg", "side.jpg", "front_and_side.json", "measuring_tiles.jpg"),
            )
        },
    }.items()
}
"""Sample pictures for users without one of their own, their clicks, and good and bad pictures to
learn from."""

SWAGGER: Final = Path(__file__).parent / "swagger"

UNCHANGING: Final = {"Cache-Control": "public, max-age=31536000, immutable"}
"""Headers of files whose names contain a hash of their content."""

FOR_A_DAY: Final = {"Cache-Control": "public, max-age=86400"}
LOOKED_AT_AGAIN: Final = {"Cache-Control": "no-cache"}

for _type, _ending in {"font/woff2": ".woff2", "image/webp": ".webp", "text/plain": ".ts"}.items():
    # Not every system has them in its table.
    mimetypes.add_type(_type, _ending)


class _Files(StaticFiles):
    """Files of a folder, or of a package."""

    def headers(self, name: str) -> dict[str, str]:
        """The headers for a file of this name."""
        del name
        return FOR_A_DAY

    def file_response(
        self,
        full_path: "os.PathLike[str] | str",
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers.update(self.headers(Path(full_path).name))
        return response


class _PageFiles(_Files):
    def headers(self, name: str) -> dict[str, str]:
        return UNCHANGING if name.count(".") >= 2 else FOR_A_DAY

    def lookup_path(self, path: str) -> tuple[str, os.stat_result | None]:
        sample = SAMPLES.get(path)
        return super().lookup_path(path) if sample is None else (str(sample), sample.stat())


class _Site(_Files):
    def headers(self, name: str) -> dict[str, str]:
        del name
        return LOOKED_AT_AGAIN | {"Content-Security-Policy": STATIC_SITE}


@ROUTER.get("/")
def page(request: Request, accept: Annotated[str, Header()] = "*/*") -> Response:
    """Return the page to browsers, and the ways in to programs that ask for JSON."""
    headers = LOOKED_AT_AGAIN | {"Vary": "Accept"}
    if "text/html" in accept:
        headers |= {"Content-Security-Policy": OWN_FILES, "Permissions-Policy": OWN_CAMERA}
        return FileResponse(PAGE / "index.html", headers=headers)
    parts: Parts = request.app.state.parts
    index = ServiceIndex(
        name=request.app.title,
        version=request.app.version,
        links=LINKS,
        retention_hours=parts.settings.retention_hours,
        max_pixels=parts.settings.max_pixels,
        max_upload_bytes=parts.settings.max_upload_bytes,
    )
    return Response(index.model_dump_json(), media_type="application/json", headers=headers)


@ROUTER.get("/try")
def trial() -> Response:
    """Lead to the page's view for developers."""
    return RedirectResponse("/#/try", status_code=307)


@ROUTER.get("/docs")
def swagger() -> Response:
    """Return the page of Swagger UI."""
    return FileResponse(SWAGGER / "index.html", headers={"Content-Security-Policy": OWN_FILES})


def mount_files(app: FastAPI) -> None:
    """Serve the files of all pages."""
    app.mount("/page", _PageFiles(directory=PAGE))
    # Installers may link a package's files from elsewhere.
    library = ("fastapi_swagger", "resources")
    swagger_files = _Files(directory=SWAGGER, packages=[library], follow_symlink=True)
    app.mount("/docs", swagger_files)
    mount_site(app, SITE)


def mount_site(app: FastAPI, folder: Path) -> None:
    """Serve the documentation; where it has not been built, lead to that of the API."""
    path = "/documentation"
    is_there = folder.is_dir()

    def lead_on(_: Request) -> Response:
        return RedirectResponse(f"{path}/" if is_there else "/docs", status_code=307)

    app.add_route(path, lead_on, include_in_schema=False)
    if is_there:
        app.mount(path, _Site(directory=folder, html=True))
    else:
        app.add_route(f"{path}/{{page:path}}", lead_on, include_in_schema=False)
