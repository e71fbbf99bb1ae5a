"""Clients generated from the contract fit the sample: type-checked, then run for real."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.contract.document import EXPORTED
from tests.e2e.service import REPOSITORY, running_service
from tests.npm_packages import installed

CLIENTS = REPOSITORY / "tests" / "clients"
SAMPLE = [
    str(REPOSITORY / "service" / "demo_data" / name) for name in ("sample.jpg", "request.json")
]
TOOLS = Path(sys.executable).parent


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with running_service(tmp_path_factory.mktemp("service")) as client:
        yield client


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


def check(output: str, service: httpx.Client) -> None:
    """Check what a client found, and that it erased the job."""
    found = json.loads(output.splitlines()[-1])
    request = json.loads(Path(SAMPLE[1]).read_text())
    assert found["measurements"]["stature"] == pytest.approx(100 * request["height_m"], abs=0.01)
    assert 40 < found["measurements"]["weight"] < 150
    assert (found["glb"], found["erased"]) == ("glTF", 204)
    assert service.get("/v1/fits").json()["jobs"] == []


def test_a_generated_python_client_fits_the_sample(service: httpx.Client, tmp_path: Path):
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
    check(run(sys.executable, "fit.py", service.base_url, *SAMPLE, cwd=tmp_path), service)


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
    run(
        *(tools / "openapi-typescript", EXPORTED, "--default-non-nullable", "false"),
        *("--output", "schema.d.ts"),
        cwd=tmp_path,
    )
    run(tools / "tsc", cwd=tmp_path)
    check(run("node", "built/fit.js", service.base_url, *SAMPLE, cwd=tmp_path), service)
