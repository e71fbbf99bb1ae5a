"""The README's commands, run as they stand there."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.e2e.service import REPOSITORY, running_service

README = (REPOSITORY / "README.md").read_text()
RUN_WITHIN_S = 600


def block(name: str) -> str:
    """The code block the README marks as tested under this name."""
    found = re.search(rf"<!-- tested: {name} -->\n```\w+\n(.*?)```", README, re.DOTALL)
    assert found, f"README.md has no tested block {name!r}"
    return found[1]


def run(command: list[str], **environment: str) -> subprocess.CompletedProcess[str]:
    """Run in the repository's root, as the README assumes."""
    return subprocess.run(
        command,
        cwd=REPOSITORY,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=RUN_WITHIN_S,
        check=False,
    )


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory):
    with running_service(tmp_path_factory.mktemp("data")) as client:
        yield str(client.base_url)


@pytest.fixture
def clean_root():
    """What the commands write into the current folder is removed again."""
    before = set(REPOSITORY.iterdir())
    yield REPOSITORY
    for path in set(REPOSITORY.iterdir()) - before:
        shutil.rmtree(path) if path.is_dir() else path.unlink()


def test_the_curl_example_brings_a_result_and_a_body(address: str, clean_root: Path):
    done = run(["bash", "-euo", "pipefail", "-c", block("curl")], SERVICE=address)
    assert done.returncode == 0, done.stderr
    assert "event: end" in done.stdout
    assert json.loads((clean_root / "result.json").read_text())["measurements"]
    assert (clean_root / "body_posed.glb").read_bytes()[:4] == b"glTF"


def test_something_is_made_of_the_fit_of_the_curl_example(address: str, clean_root: Path):
    commands = block("curl") + block("derivation")
    done = run(["bash", "-euo", "pipefail", "-c", commands], SERVICE=address)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("event: end") == 2
    assert (clean_root / "body_textured.glb").read_bytes()[:4] == b"glTF"


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node.js to run the fetch example")
def test_the_fetch_example_prints_measurements(address: str):
    done = run(["node", "--input-type=module", "-e", block("fetch")], SERVICE=address)
    assert done.returncode == 0, done.stderr
    assert "waist_girth_navel" in done.stdout


def test_the_command_line_example_writes_all_files(clean_root: Path):
    if not (REPOSITORY / ".venv" / "bin" / "maquette").exists():
        pytest.skip("the README's .venv is not there: run through make test")
    done = run(["bash", "-euo", "pipefail", "-c", block("fit")])
    assert done.returncode == 0, done.stdout + done.stderr
    assert (clean_root / "fit-output" / "overlay.png").exists()


def test_make_demo_prints_measurements_beside_the_truth(clean_root: Path):
    if not (REPOSITORY / ".venv" / ".installed").exists():
        pytest.skip("make has not set up .venv: run through make test")
    done = run(["make", "demo"])
    assert done.returncode == 0, done.stdout + done.stderr
    for word in ("SES", "truth", "waist", "demo-output"):
        assert word in done.stdout
    assert (clean_root / "demo-output" / "body_posed.glb").exists()


def test_the_two_commands_stand_in_the_makefile():
    makefile = (REPOSITORY / "Makefile").read_text()
    for command in re.findall(r"^make (\w+)", README, re.MULTILINE):
        assert re.search(rf"^{command}:", makefile, re.MULTILINE), command


def test_the_readmes_files_exist():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert target.startswith("https://") or (REPOSITORY / target).exists(), target
