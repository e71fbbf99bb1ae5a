"""There is one version, and all that names one names it."""

import json
import re
import subprocess
import tomllib
from datetime import date
from importlib.metadata import version
from pathlib import Path

import pytest

from service.api.app import openapi_text
from service.version import VERSION
from tests.contract.document import exported

REPOSITORY = Path(__file__).parents[3]
NAMED = re.compile(r"\bmaquette[:-](\d+\.\d+\.\d+)\b|\bnewTag: (\S+)")
"""Images, wheels and archives."""

HEADING = re.compile(r"^## (.*)$", re.MULTILINE)


def test_it_is_three_numbers():
    assert re.fullmatch(r"\d+\.\d+\.\d+", VERSION)


def test_the_build_reads_it_where_the_service_does():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())
    assert "version" not in project["project"]
    assert "version" in project["project"]["dynamic"]
    path = REPOSITORY / project["tool"]["hatch"]["version"]["path"]
    assert re.findall(r'^VERSION = "(.+)"$', path.read_text(), re.MULTILINE) == [VERSION]


def test_what_is_installed_has_it():
    assert version("maquette") == VERSION, "run `make`: it installs anew"


def test_the_contract_has_it():
    assert json.loads(openapi_text())["info"]["version"] == VERSION
    assert exported()["info"]["version"] == VERSION, "run `make openapi`"


def test_documents_and_manifests_name_no_other():
    if not (REPOSITORY / ".git").exists():
        pytest.skip("no git to say which files are ours")
    command = ["git", "ls-files", "*.md", "*.yaml", "*.sh", "Makefile", "docker/Dockerfile"]
    listed = subprocess.run(command, cwd=REPOSITORY, check=True, capture_output=True, text=True)
    named = {
        (name, "".join(found))
        for name in listed.stdout.splitlines()
        for found in NAMED.findall((REPOSITORY / name).read_text())
    }
    assert {each for _, each in named} == {VERSION}, named


def test_the_pythons_that_are_named_are_those_of_the_page_of_releases():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    named = re.findall(r"Python :: (3\.\d+)", "\n".join(project["classifiers"]))
    page = (REPOSITORY / "service/docs/operate/release.md").read_text()
    (section,) = re.findall(r"^## Pythons\n(.*?)^## ", page, re.MULTILINE | re.DOTALL)
    assert re.findall(r"^\| (3\.\d+)", section, re.MULTILINE) == named
    assert project["requires-python"] == f">={named[0]}"


def test_the_changelog_s_newest_version_is_this_one_or_changes_wait_for_the_next():
    (first, waiting), (heading, changes), *_ = changelog()
    assert first == "Unreleased"
    newest, _, day = heading.partition(" - ")
    assert newest == VERSION or waiting.strip()
    assert date.fromisoformat(day)
    assert changes.strip(), "a version says what is new"


def changelog() -> list[tuple[str, str]]:
    """The changelog's sections, each by its heading."""
    parts = HEADING.split((REPOSITORY / "CHANGELOG.md").read_text())[1:]
    return list(zip(parts[::2], parts[1::2], strict=True))
