"""Clients generated from the contract fit the samples: type-checked, then run for real."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from tests.contract.document import EXPORTED
from tests.e2e.service import REPOSITORY, fits
from tests.external_tools import installed

CLIENTS = REPOSITORY / "tests" / "clients"
DEMO = REPOSITORY / "service" / "demo_data"
SAMPLE = [str(DEMO / name) for name in ("request.json", "sample.jpg")]
PAIR = [str(DEMO / name) for name in ("front_and_side.json", "front.jpg", "side.jpg")]
TOOLS = Path(sys.executable).parent


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
