"""The documentation site as the service serves it."""

import asyncio
import re
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

from service.api import documentation, documentation_sources
from service.api.problems import install_problem_handlers

Get = Callable[..., httpx.Response]


@pytest.fixture
def get(tmp_path: Path) -> Get:
    folder = tmp_path / "site"
    (folder / "guide").mkdir(parents=True)
    (folder / "index.html").write_text("<h1>Maquette</h1>")
    (folder / "guide" / "scans.html").write_text("<h1>Front and side</h1>")
    (tmp_path / "secret.txt").write_text("not of the site")
    return getting(folder)


def getting(folder: Path, sources: Path = Path("/nowhere")) -> Get:
    app = FastAPI(redirect_slashes=False)
    install_problem_handlers(app)
    documentation.mount_site(app, folder, sources)

    def get(path: str, **headers: str) -> httpx.Response:
        async def asked() -> httpx.Response:
            transport = httpx.ASGITransport(app)
            async with httpx.AsyncClient(transport=transport, base_url="http://maquette") as client:
                return await client.get(path, headers=headers, follow_redirects=True)

        return asyncio.run(asked())

    return get


def test_the_path_alone_leads_to_the_first_page(get: Get):
    answer = get("/documentation")
    assert [each.status_code for each in answer.history] == [308]
    assert "Maquette" in answer.text


def test_pages_may_load_the_services_own_files_alone(get: Get):
    answer = get("/documentation/guide/scans.html")
    assert answer.headers["content-type"].startswith("text/html")
    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self';" in policy
    again = get("/documentation/guide/scans.html", **{"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304


@pytest.mark.parametrize("path", ["nothing.html", "../secret.txt", "%2e%2e/secret.txt"])
def test_only_the_sites_files_are_served(get: Get, path: str):
    answer = get(f"/documentation/{path}")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("path", ["", "/", "/guide/scans.html"])
def test_a_service_without_the_site_says_how_to_get_it(tmp_path: Path, path: str):
    answer = getting(tmp_path / "nowhere")(f"/documentation{path}")
    assert answer.status_code == 404
    assert answer.json()["code"] == "not-found"
    assert "without its documentation" in answer.json()["detail"]
    assert "make docs" in answer.json()["remedy"]


def test_a_browser_that_finds_no_site_is_led_to_the_api(tmp_path: Path):
    answer = getting(tmp_path / "nowhere")("/documentation/", Accept="text/html,*/*")
    assert [(each.status_code, each.headers["location"]) for each in answer.history] == [
        (307, "/docs")
    ]


@pytest.fixture
def clone(tmp_path: Path) -> Get:
    return getting(tmp_path / "nowhere", documentation.SOURCES)


def test_a_clone_without_the_site_shows_its_sources(clone: Get):
    first = clone("/documentation")
    assert first.url.path == "/documentation/index.html"
    assert "default-src 'none'" in first.headers["content-security-policy"]
    front_end = clone("/documentation/guide/front_end.html").text
    assert "<h1 id=" in front_end
    assert '<a href="/documentation/guide/results.html">' in front_end
    assert "table" in front_end
    assert clone("/documentation/style.css").headers["content-type"].startswith("text/css")


def test_every_page_of_the_sources_is_shown_and_every_link_leads_somewhere(clone: Get):
    waiting, seen = ["/documentation/index.html"], set[str]()
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        answer = clone(path)
        assert answer.status_code == 200, path
        if path.endswith(".html"):
            assert "```" not in re.sub(r"<pre>.*?</pre>", "", answer.text, flags=re.DOTALL), path
            linked = re.findall(r'(?:href|src)="(/documentation/[^"#]+)', answer.text)
            waiting += [each for each in linked if each not in seen]
    shown = {each.removeprefix("/documentation/").removesuffix(".html") for each in seen}
    sources = documentation.SOURCES
    written = {str(each.relative_to(sources).with_suffix("")) for each in sources.rglob("*.md")}
    generated = {each for each in written if each.startswith(("reference/http", "gallery"))}
    assert written - generated <= shown


def test_a_page_comes_before_the_list_of_all_pages_which_phones_show_below_it(clone: Get):
    page = clone("/documentation/guide/front_end.html").text
    assert page.index("<h1 id=") < page.index('<nav id="pages">')
    assert '<a class="to-pages" href="#pages">' in page


@pytest.mark.parametrize(
    "path",
    [
        *("../../README.html", "%2e%2e/%2e%2e/README.html", "files/service/cli.py", "files/x.png"),
        *("%00.html", "files/%00.png", f"{300 * 'long'}.html", f"files/{300 * 'long'}.png"),
    ],
)
def test_a_clone_shows_pages_and_their_pictures_alone(clone: Get, path: str):
    assert clone(f"/documentation/{path}").status_code == 404


def test_a_clone_shows_no_pictures_but_those_of_its_pages(tmp_path: Path):
    shown, other = tmp_path / documentation_sources.PICTURES[0], tmp_path / "maquette-fit"
    sources = tmp_path / "service" / "docs"
    for folder in (sources, other, *(tmp_path / each for each in documentation_sources.PICTURES)):
        folder.mkdir(parents=True)
    (sources / "index.md").write_text("# Maquette")
    for folder in (shown, other):
        (folder / "overlay.png").write_bytes(b"PNG")
    clone = getting(tmp_path / "nowhere", sources)
    assert clone(f"/documentation/files/{documentation_sources.PICTURES[0]}/overlay.png").is_success
    assert clone("/documentation/files/maquette-fit/overlay.png").status_code == 404
