"""Our clients as strangers use them, against a running service: Python, TypeScript."""

import json
import shutil
import socket
import subprocess
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Route, sync_playwright

from api_schemas.client import Maquette, MaquetteError
from api_schemas.fit import FitRequest
from api_schemas.products.bodies import CaricatureOptions
from fitter.vocabulary.choices import Gender
from service.version import VERSION
from tests.contract.document import REPOSITORY
from tests.e2e.page.visitor import chromium
from tests.external_tools import installed
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import Service
from tests.integration.service.test_products import BVH

KNOWN = {"gender": "female", "height_m": 1.68}
SEVERAL = {"gender": "female", "views": [{"view": "front"}, {"view": "side"}]}


@pytest.fixture
def maquette(service: Service):
    with Maquette(str(service.client.base_url)) as client:
        yield client


def test_a_picture_is_fitted_and_measured(maquette: Maquette, tmp_path: Path):
    picture = tmp_path / "picture.png"
    picture.write_bytes(scripted_image())
    seen: list[str | None] = []
    fit = maquette.fit(KNOWN, picture, on_progress=lambda each: seen.append(each.stage))
    assert {"segmentation", "measurement"} <= set(seen)
    result = maquette.result(fit)
    assert (result.height_m, len(result.stages)) == (1.68, 1)
    assert maquette.file(fit, "body_canonical.glb").startswith(b"glTF")
    maquette.erase(fit)
    with pytest.raises(MaquetteError) as gone:
        maquette.result(fit)
    assert gone.value.status == 404


def test_a_product_is_made_and_its_files_are_read(maquette: Maquette):
    fit = maquette.fit(KNOWN, scripted_image({"product": {"seconds": 3.0}}))
    seen: list[float] = []
    posed = maquette.product(fit, {"kind": "pose"}, on_progress=lambda so: seen.append(so.progress))
    assert 0.5 in seen
    assert maquette.file(posed, "body_reposed.glb").startswith(b"glTF")
    moved = maquette.product(fit, {"kind": "animation"}, bvh=BVH.encode())
    assert moved.kind == "animation"
    with pytest.raises(MaquetteError, match="Send a factor") as refused:
        maquette.product(fit, CaricatureOptions(kind="caricature", factor=7.0))
    assert refused.value.problem is not None
    assert refused.value.problem.field == "factor"


def test_a_request_may_be_of_the_packages_own_type_and_have_a_mask(maquette: Maquette):
    asked = FitRequest(gender=Gender.FEMALE, height_m=1.7)
    fit = maquette.fit(asked, scripted_image(), masks=[scripted_image()])
    assert "views/0/mask" in fit.links.files


def test_who_does_not_answer_is_named():
    with socket.socket() as bound:  # to a port where nothing listens
        bound.bind(("127.0.0.1", 0))
        address = f"http://127.0.0.1:{bound.getsockname()[1]}"
        with Maquette(address) as client, pytest.raises(MaquetteError, match=address) as away:
            client.fit(KNOWN, b"")
    assert (away.value.status, away.value.problem) == (None, None)


def test_two_pictures_are_one_fit(maquette: Maquette):
    fit = maquette.fit(SEVERAL, scripted_image(), scripted_image({"n": 1}))
    assert [view.view for view in maquette.result(fit).views] == ["front", "side"]


def test_what_is_sent_again_with_its_key_is_the_same_fit(maquette: Maquette):
    first, again = (
        maquette.fit(KNOWN, scripted_image(), idempotency_key="as before") for _ in range(2)
    )
    assert first.id == again.id
    assert maquette.fit(KNOWN, scripted_image()).id != first.id


def test_what_is_refused_or_has_failed_says_what_to_do(maquette: Maquette):
    with pytest.raises(MaquetteError, match="height") as refused:
        maquette.fit(KNOWN | {"height_m": 9}, scripted_image())
    assert refused.value.problem is not None
    assert refused.value.problem.errors[0].field == "height_m"
    with pytest.raises(MaquetteError, match="Send the whole file"):
        maquette.fit(KNOWN, scripted_image({"unusable": True}))


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
