"""What makes a release refuses what must not be one, and can go on where it ended."""

import os
import shutil
import subprocess
import tarfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
VERSION = "2.3.4"
CHANGELOG = """# Changelog

## Unreleased

## 2.3.4 - 2026-01-31

- News.

## 2.3.3 - 2026-01-01
"""
NAME = {"GIT_AUTHOR_NAME": "N", "GIT_AUTHOR_EMAIL": "n@localhost"}
NAME |= {key.replace("AUTHOR", "COMMITTER"): value for key, value in NAME.items()}
DISTRIBUTIONS = (f"maquette-{VERSION}-py3-none-any.whl", f"maquette-{VERSION}.tar.gz")


class Project:
    """A small repository with the script, and programs of its own before all others."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "project"
        self.programs = folder / "programs"
        self.programs.mkdir()
        for name, text in {
            "service/version.py": f'VERSION = "{VERSION}"\n',
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
    archive = project.folder / "dist" / f"maquette-{VERSION}-documentation.tar.gz"
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
