"""The wheel, the source distribution, and the script that makes a release of them."""

import ast
import os
import re
import shutil
import subprocess
import sys
import tarfile
from importlib.metadata import packages_distributions
from pathlib import Path
from zipfile import ZipFile

import pytest
from packaging.metadata import RawMetadata, parse_email
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from service.version import VERSION
from tests.installation import applies, built

REPOSITORY = Path(__file__).parents[2]
EXTRAS = ("s3", "detector", "heic")
"""Of users; the others are for those who develop and evaluate."""

COMPANIONS = ("pydantic_core", "botocore")
"""Of pydantic and boto3, which each bring their own in the version that fits, and document it."""

PACKAGES = ("api_schemas", "fitter", "service")
MAX_WHEEL_BYTES = 20_000_000

NOT_INSTALLED = (
    r"service/page/(?!dist/).*",
    r"service/demo_data/(result|measuring|page_clicking|page_result)\.jpg",
    r"fitter/measurement/atlas/.*",
    r"service/docs/.*",
    r"api_schemas/(released|typescript)/.*",
)
"""Sources of the page, documents and their pictures, documents of earlier versions."""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return built(REPOSITORY, "wheel", tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def files(wheel: Path) -> set[str]:
    with ZipFile(wheel) as archive:
        return set(archive.namelist())


@pytest.fixture(scope="module")
def metadata(wheel: Path) -> RawMetadata:
    with ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        known, unknown = parse_email(archive.read(name))
    assert not unknown
    return known


def test_the_wheel_holds_every_file_that_runs_and_no_other(files: set[str]):
    if not (REPOSITORY / ".git").exists():
        pytest.skip("no git to say which files are ours")
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *PACKAGES]
    ours = subprocess.run(command, cwd=REPOSITORY, check=True, capture_output=True, text=True)
    wanted = {
        name
        for name in ours.stdout.splitlines()
        if not any(re.fullmatch(pattern, name) for pattern in NOT_INSTALLED)
    }
    assert {name for name in files if ".dist-info/" not in name} == wanted
    assert {name.partition("/")[0] for name in files if ".dist-info/" not in name} == {*PACKAGES}


def test_whatever_is_imported_is_required_by_its_name(wheel: Path, metadata: RawMetadata):
    requirements = [Requirement(text) for text in metadata["requires_dist"]]
    required = {
        canonicalize_name(requirement.name)
        for requirement in requirements
        if any(applies(requirement, extra=extra) for extra in ("", *EXTRAS))
    }
    carriers = packages_distributions()
    foreign = imported(wheel) - {*PACKAGES, *sys.stdlib_module_names, *COMPANIONS}
    carried = {name: {canonicalize_name(each) for each in carriers[name]} for name in foreign}
    assert [name for name in sorted(foreign) if not required & carried[name]] == []


def imported(wheel: Path) -> set[str]:
    """The top-level names of all that the modules in a wheel import, wherever they do."""
    names: set[str] = set()
    with ZipFile(wheel) as archive:
        for file in archive.namelist():
            if not file.endswith(".py"):
                continue
            for node in ast.walk(ast.parse(archive.read(file))):
                if isinstance(node, ast.Import):
                    names |= {each.name.partition(".")[0] for each in node.names}
                elif isinstance(node, ast.ImportFrom):
                    assert node.level == 0, file
                    names.add(str(node.module).partition(".")[0])
    return names


def test_the_wheel_weighs_little(wheel: Path):
    assert wheel.stat().st_size <= MAX_WHEEL_BYTES


def test_a_source_distribution_gives_the_same_wheel(wheel: Path, tmp_path: Path):
    archive = built(REPOSITORY, "sdist", tmp_path / "sdist")
    source = tmp_path / "source"
    source.mkdir()
    command = ["tar", "--extract", "--strip-components=1", "--file", archive]
    subprocess.run([*command, "--directory", source], check=True)
    assert built(source, "wheel", tmp_path / "wheel").read_bytes() == wheel.read_bytes()


def test_it_has_the_version_of_the_service(metadata: RawMetadata):
    assert metadata["version"] == VERSION


def test_the_description_is_the_readme_without_what_only_the_repository_has(metadata: RawMetadata):
    text = metadata["description"]
    assert metadata["description_content_type"] == "text/markdown"
    assert text.startswith("# Maquette\n")
    assert "make demo" in text
    assert "![" not in text
    assert "[Accuracy](" in (REPOSITORY / "README.md").read_text()
    assert "\nAccuracy says" in text
    targets = re.findall(r"\]\(([^)]*)\)", text)
    assert all(target.startswith("https://") for target in targets)


def test_licences_of_all_that_is_inside_come_with_it(metadata: RawMetadata, files: set[str]):
    assert metadata["license_expression"] == "Apache-2.0 AND MIT AND OFL-1.1 AND CC0-1.0"
    of_the_page = (REPOSITORY / "service/page/dist/THIRD_PARTY.txt").read_text()
    assert "MIT License" in of_the_page
    assert "SIL OPEN FONT LICENSE" in of_the_page
    (folder,) = {name.partition("/")[0] for name in files if ".dist-info/" in name}
    assert {"LICENSE", "NOTICE", "service/page/dist/THIRD_PARTY.txt"} <= {
        *metadata["license_files"]
    }
    assert {f"{folder}/licenses/{name}" for name in metadata["license_files"]} <= files


RELEASED = "2.3.4"
CHANGELOG = """# Changelog

## Unreleased

## 2.3.4 - 2026-01-31

- News.

## 2.3.3 - 2026-01-01
"""
NAME = {"GIT_AUTHOR_NAME": "N", "GIT_AUTHOR_EMAIL": "n@localhost"}
NAME |= {key.replace("AUTHOR", "COMMITTER"): value for key, value in NAME.items()}
DISTRIBUTIONS = (f"maquette-{RELEASED}-py3-none-any.whl", f"maquette-{RELEASED}.tar.gz")


class Project:
    """A small repository with the script, and programs of its own before all others."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "project"
        self.programs = folder / "programs"
        self.programs.mkdir()
        for name, text in {
            "service/version.py": f'VERSION = "{RELEASED}"\n',
            "CHANGELOG.md": CHANGELOG,
            ".gitignore": "build/\ndist/\nservice/docs_site/\n",
        }.items():
            self.write(name, text)
        (self.folder / ".ci").mkdir()
        shutil.copy2(REPOSITORY / ".ci" / "release", self.folder / ".ci")
        self.git("init", "-q")
        self.commit()

    def write(self, name: str, text: str) -> None:
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text)

    def git(self, *arguments: str) -> None:
        command = ["git", "-c", "commit.gpgsign=false", *arguments]
        subprocess.run(command, cwd=self.folder, env=os.environ | NAME, check=True)

    def commit(self) -> None:
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "A state")

    def program(self, name: str, text: str) -> None:
        (self.programs / name).write_text(f"#!/bin/sh\n{text}\n")
        (self.programs / name).chmod(0o755)

    def release(self, *steps: str, **variables: str) -> subprocess.CompletedProcess[str]:
        path = f"{self.programs}:{os.environ['PATH']}"
        return subprocess.run(
            [self.folder / ".ci" / "release", *steps],
            env={"PATH": path, "HOME": str(self.programs), **variables},
            capture_output=True,
            text=True,
            check=False,
        )

    def refuses(self, *steps: str, **variables: str) -> str:
        done = self.release(*steps, **variables)
        assert done.returncode == 1, done.stdout + done.stderr
        return done.stderr


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return Project(tmp_path)


def test_a_dated_version_in_a_clean_tree_may_be_released(project: Project):
    done = project.release("check")
    assert done.returncode == 0, done.stderr


def test_a_tree_with_changes_is_refused(project: Project):
    project.write("service/new.py", "")
    assert "the tree has changes" in project.refuses("check")


@pytest.mark.parametrize(
    "changelog",
    [
        CHANGELOG.replace(" - 2026-01-31", ""),
        CHANGELOG.replace("2.3.4", "2.3.5"),
        CHANGELOG.replace("2.3.4", "2x3x4"),
    ],
)
def test_a_changelog_that_does_not_date_the_version_is_refused(project: Project, changelog: str):
    project.write("CHANGELOG.md", changelog)
    project.commit()
    assert "no dated section" in project.refuses("check")


def test_changes_that_stand_under_no_version_are_refused(project: Project):
    project.write("CHANGELOG.md", CHANGELOG.replace("Unreleased\n", "Unreleased\n\n- More.\n"))
    project.commit()
    assert "entries under Unreleased" in project.refuses("check")


def test_a_step_that_there_is_not_begins_nothing(project: Project):
    project.write("service/new.py", "")
    assert "no such step: chekc" in project.refuses("check", "chekc")


def test_without_a_docker_engine_an_image_is_not_left_out_silently(project: Project):
    project.program("docker", "exit 1")
    assert "no Docker engine answers" in project.refuses("image")
    done = project.release("image", IMAGE="no")
    assert done.returncode == 0
    assert "without an image" in done.stdout


def test_the_documentation_of_one_commit_is_the_same_archive(project: Project):
    site = project.folder / "service" / "docs_site"
    archive = project.folder / "dist" / f"maquette-{RELEASED}-documentation.tar.gz"
    project.program("make", f"mkdir -p {site} && rm -rf {site}/* && echo page > {site}/index.html")
    assert project.release("docs").returncode == 0
    first = archive.read_bytes()
    with tarfile.open(archive) as opened:
        assert opened.getnames() == ["docs_site", "docs_site/index.html"]
    project.program("make", f"touch -d 2001-01-01 {site}/index.html && chmod 600 {site}/index.html")
    assert project.release("docs").returncode == 0
    assert archive.read_bytes() == first


def test_sums_are_of_what_is_in_the_release(project: Project):
    for name in (*DISTRIBUTIONS, "of_before.txt"):
        project.write(f"dist/{name}", name)
    assert project.release("sums").returncode == 0
    sums = (project.folder / "dist" / "SHA256SUMS").read_text()
    assert {line.split()[1] for line in sums.splitlines()} == set(DISTRIBUTIONS)
