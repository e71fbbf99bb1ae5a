"""The wheel alone, in an environment of its own and far from the repository, is all of Maquette."""

import json
import os
import re
import shutil
import stat
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from api_schemas.results import FitResult
from service.version import VERSION
from tests.contract.document import EXPORTED
from tests.e2e.service import (
    REPOSITORY,
    started_service,
    wait_until_ready,
)
from tests.installation import Installation, built, installed

pytestmark = pytest.mark.slow

WITHOUT_ROOTS_RIGHTS = ("setpriv", "--bounding-set=-dac_override,-dac_read_search")
"""Root may write wherever it likes; run by this, it may not."""

STRANGER = """
from pathlib import Path
from typing import assert_type

from api_schemas.results import FitResult
from fitter.body.model import BodyModel
from fitter.body.storage import load_body_model
from service.settings import Settings

assert_type(load_body_model(Path("female.npz")), BodyModel)
assert_type(FitResult.model_validate_json("{}").height_m, float)
assert_type(Settings().port, int)
"""
MISTAKEN = """
from fitter.body.storage import load_body_model

load_body_model(3)
"""


@pytest.fixture(scope="module")
def installation(tmp_path_factory: pytest.TempPathFactory) -> Installation:
    """The wheel, with its kernels as they are compiled from the same sources."""
    folder = tmp_path_factory.mktemp("installed")
    made = installed(built(REPOSITORY, "wheel", folder / "wheel"), folder / "environment")
    # Numba tells sources by their content.
    for file in (REPOSITORY / "fitter").rglob("*.nb[ci]"):
        place = made.packages / file.relative_to(REPOSITORY)
        place.parent.mkdir(exist_ok=True)
        shutil.copyfile(file, place)
    done = made.run(made.python, "-m", "service.compute.kernels", cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    return made


@pytest.fixture(scope="module")
def service(
    installation: Installation, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[httpx.Client]:
    command = [str(installation.maquette), "serve", "--port", "0"]
    folder = tmp_path_factory.mktemp("started")
    with started_service(command, cwd=folder, environment=installation.environment()) as client:
        wait_until_ready(client)
        yield client


def test_nothing_is_imported_from_elsewhere(installation: Installation, tmp_path: Path):
    program = "import api_schemas, fitter, service\n"
    program += "for each in (api_schemas, fitter, service): print(each.__file__)"
    done = installation.run(installation.python, "-c", program, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    places = done.stdout.splitlines()
    assert all(place.startswith(str(installation.packages)) for place in places)
    assert not list(installation.packages.glob("pytest*"))


def test_the_page_comes_with_its_scripts_samples_and_the_documentation(service: httpx.Client):
    page = service.get("/", headers={"Accept": "text/html"}).raise_for_status()
    needed = re.findall(r'(?:src|href)="(/[^"]+)"', page.text)
    assert needed
    samples = [f"/page/{name}.{kind}" for name in ("sample", "woman") for kind in ("jpg", "json")]
    for path in [*needed, *samples, "/docs", "/docs/swagger-ui-bundle.js"]:
        assert service.get(path).raise_for_status().content, path
    assert service.get("/openapi.json").json() == json.loads(EXPORTED.read_text())


def test_the_demo_and_a_fit_without_a_service_leave_their_files(
    installation: Installation, tmp_path: Path
):
    demo = installation.run(installation.maquette, "demo", cwd=tmp_path)
    assert demo.returncode == 0, demo.stdout + demo.stderr
    samples = installation.packages / "service" / "demo_data"
    given = [samples / "request.json", samples / "sample.jpg"]
    fit = installation.run(installation.maquette, "fit", *given, cwd=tmp_path)
    assert fit.returncode == 0, fit.stdout + fit.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"demo-output", "maquette-fit"}
    for folder in tmp_path.iterdir():
        FitResult.model_validate_json((folder / "result.json").read_bytes())
        assert (folder / "views" / "0" / "body_posed.glb").exists()


def test_other_commands_need_nothing_more(installation: Installation, tmp_path: Path):
    def said(*command: str | Path) -> str:
        done = installation.run(*command, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        return done.stdout

    maquette = installation.maquette
    assert said(maquette, "--version") == f"maquette {VERSION}\n"
    assert said(maquette, "keys", "create", "somebody") != ""
    training = [installation.python, "-m", "fitter.training"]
    guide = said(*training, "template", "--meshes", "bodies", "--gender", "female").split()[-1]
    assert Path(guide.rstrip(".")).is_relative_to(installation.packages)
    assert Path(guide.rstrip(".")).read_text().startswith("# Bodies of your own")
    untrained = installation.run(*training, "build", "--output", "models", cwd=tmp_path)
    assert untrained.returncode == 1
    assert untrained.stderr.startswith("Training the packaged models reads")


@contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """Nobody may write into the folder and those in it."""
    folders = [path for path in (folder, *folder.rglob("*")) if path.is_dir()]
    for path in folders:
        path.chmod(stat.S_IRUSR | stat.S_IXUSR)
    try:
        yield
    finally:
        for path in folders:
            path.chmod(stat.S_IRWXU)


def test_what_somebody_else_installed_works_for_a_user_without_a_home(
    installation: Installation, tmp_path: Path
):
    confined = WITHOUT_ROOTS_RIGHTS if os.geteuid() == 0 else ()
    if confined and shutil.which("setpriv") is None:
        pytest.skip("root without setpriv: everything can be written")
    for name in ("home", "temporary"):
        (tmp_path / name).mkdir()
    samples = installation.packages / "service" / "demo_data"
    picture = tmp_path / "truncated.jpg"
    picture.write_bytes((samples / "sample.jpg").read_bytes()[:20_000])
    # Told only once all compiled code is loaded, and before any of it is compiled.
    with read_only(installation.packages), read_only(tmp_path / "home"):
        done = installation.run(
            *(*confined, installation.maquette, "fit", samples / "request.json", picture),
            cwd=tmp_path,
            HOME=str(tmp_path / "home"),
            XDG_CACHE_HOME=str(tmp_path / "home" / "caches"),
            TMPDIR=str(tmp_path / "temporary"),
        )
    assert "truncated or damaged" in done.stdout, done.stdout + done.stderr
    assert list((tmp_path / "temporary").iterdir()) == []


def checked(folder: Path, python: Path, program: str) -> subprocess.CompletedProcess[str]:
    """Have a program of a stranger type-checked, strictly."""
    (folder / "pyrightconfig.json").write_text('{"typeCheckingMode": "strict"}')
    (folder / "program.py").write_text(program)
    command = [sys.executable, "-m", "pyright", "--pythonpath", python, "program.py"]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )


def test_a_strangers_program_is_checked_against_our_types(
    installation: Installation, tmp_path: Path
):
    right = checked(tmp_path, installation.python, STRANGER)
    assert right.returncode == 0, right.stdout
    wrong = checked(tmp_path, installation.python, MISTAKEN)
    assert "reportArgumentType" in wrong.stdout
