"""A release stands on images named by their digests, and has the project's version."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from service.version import VERSION
from tests.unit.service.test_docker_files import DOCKER, REPOSITORY, instructions, of_the_image

DIGEST = "sha256:" + 64 * "a"
TAGGED = "python:3.13-slim-trixie"


def build_check(**arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the Dockerfile's check of its arguments, as a build would."""
    (check,) = [each for name, each in instructions() if name == "RUN" and "${BASE_IMAGE}" in each]
    return subprocess.run(
        ["sh", "-c", check],
        cwd=REPOSITORY,
        env={"PATH": os.environ["PATH"], "VERSION": "", **arguments},
        capture_output=True,
        text=True,
        check=False,
    )


def named_images() -> dict[str, str]:
    lines = (DOCKER / "images.env").read_text().splitlines()
    return dict(line.split("=", 1) for line in lines if line and not line.startswith("#"))


def test_an_image_to_try_things_out_stands_on_any_base():
    assert build_check(BASE_IMAGE=TAGGED).returncode == 0


def test_a_release_is_refused_on_a_base_that_may_change():
    refused = build_check(BASE_IMAGE=TAGGED, VERSION=VERSION)
    assert refused.returncode != 0
    assert "digest" in refused.stderr
    assert build_check(BASE_IMAGE=f"{TAGGED}@{DIGEST}", VERSION=VERSION).returncode == 0


def test_a_release_is_refused_by_a_version_that_is_not_the_project_s():
    refused = build_check(BASE_IMAGE=f"{TAGGED}@{DIGEST}", VERSION=f"{VERSION}1")
    assert refused.returncode != 0
    assert "another version" in refused.stderr


def test_the_image_is_labelled_with_what_it_is_made_of():
    (labels,) = of_the_image("LABEL")
    told = dict(re.findall(r'org\.opencontainers\.image\.([\w.]+)="([^"]*)"', labels))
    assert told["version"] == "${VERSION:-development}"
    assert told["revision"] == "${REVISION}"
    assert told["created"] == "${CREATED}"
    assert told["base.name"] == "${BASE_IMAGE}"
    assert {"VERSION=", "REVISION=", "CREATED=", "BASE_IMAGE"} <= set(of_the_image("ARG"))


def test_files_that_name_an_image_name_the_same():
    named = {name: image.partition("@")[0] for name, image in named_images().items()}
    compose = (DOCKER / "compose.yaml").read_text()
    assert dict(re.findall(r"\$\{(\w+_IMAGE):-([^}]+)\}", compose)) == named
    assert ("ARG", f"BASE_IMAGE={named['BASE_IMAGE']}") in instructions()


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """The script and the names of images, beside a docker that knows one digest."""
    for name in ("pin_images.sh", "images.env"):
        shutil.copy2(DOCKER / name, tmp_path)
    docker = tmp_path / "bin" / "docker"
    docker.parent.mkdir()
    docker.write_text(
        '#!/bin/sh\n[ "$1 $2 $3" = "buildx imagetools inspect" ] || exit 2\n'
        f'echo "$4" >> {tmp_path}/asked\necho "$DIGEST"\n'
    )
    docker.chmod(0o755)
    return tmp_path


def pin(folder: Path, digest: str) -> subprocess.CompletedProcess[str]:
    path = f"{folder / 'bin'}:{os.environ['PATH']}"
    return subprocess.run(
        [folder / "pin_images.sh"],
        env={"PATH": path, "DIGEST": digest},
        capture_output=True,
        text=True,
        check=False,
    )


def test_digests_are_written_behind_the_names_and_later_ones_in_their_place(copied: Path):
    names = {name: image.partition("@")[0] for name, image in named_images().items()}
    for digest in (DIGEST, "sha256:" + 64 * "b"):
        assert pin(copied, digest).returncode == 0
        written = (copied / "images.env").read_text()
        for name, image in names.items():
            assert f"{name}={image}@{digest}\n" in written
        assert written.startswith("#")
    assert (copied / "asked").read_text().split() == [*names.values()] * 2


def test_names_stay_as_they_were_where_no_digest_is_told(copied: Path):
    before = (copied / "images.env").read_text()
    refused = pin(copied, "")
    assert refused.returncode != 0
    assert "no digest" in refused.stderr
    assert (copied / "images.env").read_text() == before
