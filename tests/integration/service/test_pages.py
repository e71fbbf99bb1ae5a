"""The page and the documentation over HTTP: to whom, how long kept, how packed."""

import asyncio
import gzip
import re
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

from api_schemas.service import ServiceIndex
from service.api import pages
from service.api.headers import COMPRESSED_FROM_BYTES
from service.api.problems import install_problem_handlers
from service.settings import Settings
from tests.integration.service.harness import Service

BROWSER = {"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"}


def index_of(service: Service) -> httpx.Response:
    return service.client.get("/", headers=BROWSER)


def named_files(service: Service) -> list[str]:
    return re.findall(r'(?:href|src)="(/page/[^"]+)"', index_of(service).text)


def test_browsers_get_the_page_with_a_policy_that_allows_nothing_inline(service: Service):
    page = index_of(service)
    assert page.headers["content-type"].startswith("text/html")
    assert page.headers["cache-control"] == "no-cache"
    policy = page.headers["content-security-policy"]
    assert "script-src 'self'" in policy
    assert "unsafe" not in policy
    assert not re.search(r"<script(?![^>]*\bsrc=)|<style|\sstyle=|\son\w+=", page.text)


def test_no_site_may_frame_the_page(service: Service):
    page = index_of(service)
    assert "frame-ancestors 'none'" in page.headers["content-security-policy"]
    assert page.headers["x-frame-options"] == "DENY"


def test_only_the_page_may_use_the_camera_and_the_sensors_of_its_level(service: Service):
    def policy_of(path: str) -> set[str]:
        policy = service.client.get(path, headers=BROWSER).headers["permissions-policy"]
        return {each.strip() for each in policy.split(",")}

    used = ("camera", "accelerometer", "gyroscope")
    assert policy_of("/") >= {f"{each}=(self)" for each in used}
    for path in ("/docs", "/v1/fits", "/page/sample.jpg"):
        assert policy_of(path) >= {f"{each}=()" for each in used}, path


def test_programs_get_the_ways_in(service: Service):
    answer = service.client.get("/")
    index = ServiceIndex.model_validate_json(answer.content)
    assert "Accept" in answer.headers["vary"]
    paths = service.client.get("/openapi.json").json()["paths"]
    described = {path for path in index.links.values() if path in paths}
    assert described == set(index.links.values()) - {"/openapi.json", "/docs"}
    assert index.version == service.client.get("/openapi.json").json()["info"]["version"]


def test_programs_and_the_page_learn_when_pictures_are_erased(service: Service):
    told = ServiceIndex.model_validate_json(service.client.get("/").content).retention_hours
    assert told == Settings().retention_hours


def test_files_with_a_hash_in_their_name_are_kept_for_ever_and_come_packed(service: Service):
    names = named_files(service)
    assert len(names) >= 3
    for name in names:
        file = service.client.get(name, headers={"Accept-Encoding": "gzip"})
        assert file.status_code == 200
        assert "immutable" in file.headers["cache-control"]
        if name.endswith((".js", ".css")) and len(file.content) >= COMPRESSED_FROM_BYTES:
            assert file.headers["content-encoding"] == "gzip"
        plain = service.client.get(name, headers={"Accept-Encoding": "identity"})
        assert "content-encoding" not in plain.headers
        assert plain.content == file.content


def test_the_sample_comes_with_its_points(service: Service):
    assert service.client.get("/page/sample.jpg").headers["content-type"] == "image/jpeg"
    (view,) = service.client.get("/page/sample.json").json()["views"]
    assert "left_hip" in view["points"]


@pytest.mark.parametrize("name", ["nothing.js", "..%2fbuild.mjs", "%2e%2e%2fpackage.json"])
def test_nothing_else_is_served(service: Service, name: str):
    answer = service.client.get(f"/page/{name}")
    assert answer.status_code == 404
    assert answer.json()["code"] == "not-found"


def test_the_page_itself_comes_packed(service: Service):
    with service.client.stream("GET", "/", headers=BROWSER | {"Accept-Encoding": "gzip"}) as page:
        raw = b"".join(page.iter_raw())
    assert gzip.decompress(raw).startswith(b"<!doctype html>")


Get = Callable[..., httpx.Response]


@pytest.fixture
def get(tmp_path: Path) -> Get:
    folder = tmp_path / "site"
    (folder / "guide").mkdir(parents=True)
    (folder / "index.html").write_text("<h1>Maquette</h1>")
    (folder / "guide" / "requests.html").write_text("<h1>Requests</h1>")
    (tmp_path / "secret.txt").write_text("not of the site")
    return getting(folder)


def getting(folder: Path) -> Get:
    app = FastAPI(redirect_slashes=False)
    install_problem_handlers(app)
    pages.mount_site(app, folder)

    def get(path: str, **headers: str) -> httpx.Response:
        async def asked() -> httpx.Response:
            transport = httpx.ASGITransport(app)
            async with httpx.AsyncClient(transport=transport, base_url="http://maquette") as client:
                return await client.get(path, headers=headers, follow_redirects=True)

        return asyncio.run(asked())

    return get


def test_the_path_alone_leads_to_the_first_page(get: Get):
    answer = get("/documentation")
    assert [each.status_code for each in answer.history] == [307]
    assert "Maquette" in answer.text


def test_pages_may_load_the_services_own_files_alone(get: Get):
    answer = get("/documentation/guide/requests.html")
    assert answer.headers["content-type"].startswith("text/html")
    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self';" in policy
    again = get("/documentation/guide/requests.html", **{"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304


@pytest.mark.parametrize("path", ["nothing.html", "../secret.txt", "%2e%2e/secret.txt"])
def test_only_the_sites_files_are_served(get: Get, path: str):
    answer = get(f"/documentation/{path}")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("path", ["", "/", "/guide/requests.html"])
def test_who_finds_no_site_is_led_to_the_api(tmp_path: Path, path: str):
    answer = getting(tmp_path / "nowhere")(f"/documentation{path}")
    assert [(each.status_code, each.headers["location"]) for each in answer.history] == [
        (307, "/docs")
    ]
