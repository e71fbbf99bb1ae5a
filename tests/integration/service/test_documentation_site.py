"""The documentation site as the service serves it."""

import asyncio
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

from service.api import pages
from service.api.problems import install_problem_handlers

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
