"""The client for TypeScript as it is published: type-checked, then run in Node and in a browser."""

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Route, sync_playwright

from service.version import VERSION
from tests.contract.document import REPOSITORY
from tests.e2e.page.browser import chromium
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import Service
from tests.npm_packages import installed

CLIENT = REPOSITORY / "api_schemas" / "typescript"
STRANGER = REPOSITORY / "tests" / "clients" / "published"
PICTURES = [scripted_image({"seconds": 1.5}), scripted_image({"n": 1})]
FOUND = {
    "waist": [84.0, 84.0],
    "interval": [82.04, 85.96],
    "stages": 1,
    "views": ["front", "side"],
    "glb": ["glTF", "glTF"],
    "refused": [422, "height_m"],
    "gone": 404,
}

IN_NODE = """
import { openAsBlob } from "node:fs";
import { measured } from "./built/measure.js";
const pictures = await Promise.all([openAsBlob("0.png"), openAsBlob("1.png")]);
console.log(JSON.stringify(await measured(process.argv[2], ...pictures)));
"""
IN_A_BROWSER = """async pictures => {
  const { measured } = await import("/stranger/measure.js");
  return measured("", ...pictures.map((bytes) => new Blob([Uint8Array.from(bytes)])));
}"""
PAGE = """<!doctype html>
<script type="importmap">{ "imports": { "maquette-client": "/stranger/maquette.js" } }</script>
"""


def run(*command: str | Path, cwd: Path) -> str:
    done = subprocess.run(
        [str(part) for part in command], cwd=cwd, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def stranger(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project that has nothing but the packed client, and is compiled against it."""
    project = tmp_path_factory.mktemp("stranger")
    sources = tmp_path_factory.mktemp("client") / "api_schemas" / "typescript"
    modules = installed(CLIENT) / "node_modules"
    shutil.copytree(CLIENT, sources, ignore=shutil.ignore_patterns("node_modules", "dist"))
    shutil.copy(CLIENT.parent / "openapi.json", sources.parent)
    (sources / "node_modules").symlink_to(modules)
    run("npm", "run", "build", cwd=sources)
    run("npm", "pack", "--pack-destination", project, cwd=sources)
    shutil.copytree(STRANGER, project, dirs_exist_ok=True)
    run("npm", "install", "--offline", f"./maquette-client-{VERSION}.tgz", cwd=project)
    run(modules / ".bin" / "tsc", cwd=project)
    return project


def check(found: dict[str, Any]) -> None:
    states = found.pop("states")
    assert states[-1] == "succeeded"
    assert len(states) > 1, "it was waited for"
    assert found == FOUND


def test_a_stranger_measures_in_node(service: Service, stranger: Path):
    for number, picture in enumerate(PICTURES):
        (stranger / f"{number}.png").write_bytes(picture)
    (stranger / "main.js").write_text(IN_NODE)
    check(json.loads(run("node", "main.js", str(service.client.base_url), cwd=stranger)))


def test_a_stranger_measures_in_a_browser(service: Service, stranger: Path):
    files = {
        "measure.js": stranger / "built" / "measure.js",
        "maquette.js": stranger / "node_modules" / "maquette-client" / "dist" / "maquette.js",
    }

    def of_the_stranger(route: Route) -> None:
        name = route.request.url.rpartition("/")[2]
        if name in files:
            route.fulfill(path=files[name], content_type="text/javascript")
        else:
            route.fulfill(body=PAGE, content_type="text/html")

    with sync_playwright() as playwright, chromium(playwright) as browser:
        page = browser.new_page()
        page.route("**/stranger/**", of_the_stranger)
        page.goto(f"{str(service.client.base_url).rstrip('/')}/stranger/")
        check(page.evaluate(IN_A_BROWSER, [list(picture) for picture in PICTURES]))
