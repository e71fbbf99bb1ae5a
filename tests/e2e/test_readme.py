"""The README's commands, run as they stand there."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import httpx
import pytest

from tests.e2e.service import REPOSITORY, ended_job
from tests.readme import README, block

RUN_WITHIN_S = 1_800
NOT_IGNORED = 1
"""Status of `git check-ignore`; that of an error is another."""


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
def address(service: httpx.Client) -> str:
    return str(service.base_url)


def would_be_committed(path: str) -> bool:
    """Whether `git add .` would take a path; nothing is committed where there is no git."""
    return run(["git", "check-ignore", "--quiet", path]).returncode == NOT_IGNORED


@pytest.fixture
def clean_root():
    """What the commands write into the current folder is removed again."""
    before = listed_root()
    yield REPOSITORY
    left = listed_root() - before
    committed = [path.name for path in left if would_be_committed(str(path))]
    for path in left:
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    assert committed == [], "add them to .gitignore"


def listed_root() -> set[Path]:
    """What lies there but for hidden folders: those are of tools that other tests may be using."""
    return {path for path in REPOSITORY.iterdir() if not path.name.startswith(".")}


def test_the_curl_examples_bring_a_result_a_texture_other_formats_and_points(
    address: str, clean_root: Path
):
    commands = block("curl") + block("product") + block("formats") + block("points")
    done = run(["bash", "-euo", "pipefail", "-c", commands], SERVICE=address)
    assert done.returncode == 0, done.stderr
    assert len(json.loads((clean_root / "points.json").read_text())["points"]) == 21
    assert json.loads((clean_root / "result.json").read_text())["measurements"]
    for name in ("body_reposed.glb", "body_textured.glb"):
        assert (clean_root / name).read_bytes()[:4] == b"glTF"
    assert (clean_root / "body_canonical.obj").read_text().count("\nf ") > 10_000
    assert (clean_root / "body_canonical.stl").stat().st_size > 10_000 * 50
    assert (clean_root / "measurements.csv").read_text().startswith("name,value,unit,")


def test_the_request_fits_the_sample_picture(address: str):
    files = {"image": (REPOSITORY / "service" / "demo_data" / "sample.jpg").read_bytes()}
    with httpx.Client(base_url=address, timeout=180.0) as client:
        answer = client.post("/v1/fits", files=files, data={"request": block("request")})
        job = ended_job(client, answer)
        assert job["state"] == "succeeded", job
        found = client.get(job["links"]["result"]).json()
    stature = next(each for each in found["measurements"] if each["name"] == "stature")
    assert stature["value"] == pytest.approx(180.4, abs=0.01)


def test_the_front_and_side_example_measures_the_sample_pair(address: str, clean_root: Path):
    done = run(["bash", "-euo", "pipefail", "-c", block("pair")], SERVICE=address)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("event: end") == 1
    assert json.loads((clean_root / "pair.json").read_text())["measurements"]
    assert (clean_root / "side_overlay.png").read_bytes()[1:4] == b"PNG"


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
    assert (clean_root / "fit-output" / "views" / "1" / "overlay.png").exists()


def test_make_demo_is_the_demo():
    done = run(["make", "--dry-run", "demo"])
    assert ".venv/bin/maquette demo" in done.stdout.splitlines()


def test_the_two_commands_stand_in_the_makefile():
    makefile = (REPOSITORY / "Makefile").read_text()
    for command in re.findall(r"^make ([\w-]+)", README, re.MULTILINE):
        assert re.search(rf"^{command}:", makefile, re.MULTILINE), command


def test_the_readmes_files_exist():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert target.startswith("https://") or (REPOSITORY / target).exists(), target
