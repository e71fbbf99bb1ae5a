"""A released version and the one that follows it, each installed from its wheel."""

import re
import shutil
import subprocess
from pathlib import Path

from tests.deployment import REPOSITORY
from tests.distributions import built
from tests.installation import Installation, installed


def released(revision: str, folder: Path) -> Installation:
    """Install what a commit or a tag holds.

    Raises
    ------
    subprocess.CalledProcessError
        If there is no such commit.
    """
    source = folder / "source"
    source.mkdir(parents=True)
    archive = subprocess.run(
        ["git", "archive", revision], cwd=REPOSITORY, capture_output=True, check=True
    )
    subprocess.run(["tar", "-x", "-C", source], input=archive.stdout, check=True)
    return _installed(source, folder)


def following(folder: Path) -> Installation:
    """Install the work tree as it stands."""
    return _installed(REPOSITORY, folder)


def version_of(installation: Installation) -> str:
    """What ``maquette --version`` says."""
    done = installation.run(installation.maquette, "--version", cwd=installation.folder)
    found = re.search(r"\d+\.\d+\S*", done.stdout)
    assert found, done.stderr
    return found[0]


def _installed(source: Path, folder: Path) -> Installation:
    made = installed(built(source, "wheel", folder / "wheel"), folder / "environment")
    for kernel in (source / "fitter").rglob("*.nb[ci]"):
        place = made.packages / kernel.relative_to(source)
        place.parent.mkdir(exist_ok=True)
        shutil.copy(kernel, place)
    return made
