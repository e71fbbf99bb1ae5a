"""The page at ``/`` and its files: built in advance (``service/page``), served as they are."""

import gzip
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Annotated, Final

from fastapi import APIRouter, Header, Request, Response

from api_schemas.service import ServiceIndex
from service.api.context import Parts
from service.api.problems import not_found
from service.api.security_headers import OWN_CAMERA, OWN_FILES

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

_TEXT_TYPES: Final = {
    "css": "text/css",
    "html": "text/html",
    "js": "text/javascript",
    "json": "application/json",
    "ts": "text/plain",
    "txt": "text/plain",
}
_PACKED_TYPES: Final = {"jpg": "image/jpeg", "webp": "image/webp", "woff2": "font/woff2"}
"""Compressed already."""

_SAMPLES: Final = {
    "sample.jpg": "sample.jpg",
    "sample.json": "request.json",
    **{name: name for name in ("woman.jpg", "woman.json", "arm_across.jpg", "arm_across.json")},
    **{
        name: name
        for name in ("front.jpg", "side.jpg", "front_and_side.json", "measuring_tiles.jpg")
    },
}
"""Sample pictures for users without one of their own, their clicks, and good and bad pictures to
learn from: the file for each name."""

_UNCHANGING: Final = "public, max-age=31536000, immutable"
"""Cache header of files whose names contain a hash of their content."""

_FOR_A_DAY: Final = "public, max-age=86400"


@dataclass(frozen=True, slots=True)
class PageFile:
    """A file of the page; ``compressed`` if compression is worthwhile."""

    content: bytes
    compressed: bytes | None
    media_type: str


@ROUTER.get("/")
def page(
    request: Request,
    accept: Annotated[str, Header()] = "*/*",
    accept_encoding: Annotated[str, Header()] = "",
) -> Response:
    """Return the page to browsers, and the ways in to programs that ask for JSON."""
    headers = {"Cache-Control": "no-cache", "Vary": "Accept, Accept-Encoding"}
    if "text/html" not in accept:
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
    headers["Content-Security-Policy"] = OWN_FILES
    headers["Permissions-Policy"] = OWN_CAMERA
    return _answer(_page_files()["index.html"], accept_encoding, headers)


@ROUTER.get("/page/{name}")
def page_file(name: str, accept_encoding: Annotated[str, Header()] = "") -> Response:
    """Return a script, a style, a font or a picture of the page."""
    found = _page_files().get(name)
    if found is None or name == "index.html":
        raise not_found(what="such file")
    headers = {
        "Cache-Control": _UNCHANGING if name.count(".") >= 2 else _FOR_A_DAY,
        "Vary": "Accept-Encoding",
    }
    return _answer(found, accept_encoding, headers)


def _answer(file: PageFile, accept_encoding: str, headers: dict[str, str]) -> Response:
    if file.compressed is not None and "gzip" in accept_encoding:
        return Response(
            file.compressed,
            media_type=file.media_type,
            headers=headers | {"Content-Encoding": "gzip"},
        )
    return Response(file.content, media_type=file.media_type, headers=headers)


@cache
def _page_files() -> dict[str, PageFile]:
    """All files by name; only these are served, whatever the path."""
    package = files("service")
    found = {each.name: _read(each) for each in (package / "page" / "dist").iterdir()}
    samples = package / "demo_data"
    return found | {name: _read(samples / file) for name, file in _SAMPLES.items()}


def _read(file: Traversable) -> PageFile:
    content = file.read_bytes()
    suffix = file.name.rpartition(".")[2]
    if suffix in _PACKED_TYPES:
        return PageFile(content, None, _PACKED_TYPES[suffix])
    return PageFile(content, gzip.compress(content, 9, mtime=0), _TEXT_TYPES[suffix])
