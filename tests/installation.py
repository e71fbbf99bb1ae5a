"""A wheel, built and installed in an environment of its own, with what it says it needs alone."""

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import Distribution, distribution
from pathlib import Path
from zipfile import ZipFile

from packaging.metadata import parse_email
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name


def built(source: Path, kind: str, folder: Path) -> Path:
    """Build a ``wheel`` or an ``sdist`` of a source tree into a folder that is empty."""
    done = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "--target", kind, "--directory", folder],
        cwd=source,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (distribution,) = folder.iterdir()
    return distribution


@dataclass(frozen=True)
class Installation:
    """An environment; its programs see neither the repository nor the tests' environment."""

    folder: Path

    @property
    def python(self) -> Path:
        return self.folder / "bin" / "python"

    @property
    def maquette(self) -> Path:
        return self.folder / "bin" / "maquette"

    @property
    def packages(self) -> Path:
        (found,) = self.folder.glob("lib/python*/site-packages")
        return found

    def environment(self) -> dict[str, str]:
        """The variables of a user who has set none of ours, nor a path of modules."""
        return {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("MAQUETTE_", "NUMBA_", "PYTHON"))
        }

    def run(
        self, *command: str | Path, cwd: Path, **variables: str
    ) -> subprocess.CompletedProcess[str]:
        """Run a command to its end."""
        return subprocess.run(
            command,
            cwd=cwd,
            env=self.environment() | variables,
            capture_output=True,
            text=True,
            check=False,
        )


def installed(wheel: Path, folder: Path) -> Installation:
    """Install a wheel into a folder that is not there yet."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    installation = Installation(folder)
    pip = [sys.executable, "-m", "pip", "--python", installation.python, "install", "--quiet"]
    subprocess.run([*pip, "--no-deps", "--no-index", wheel], check=True)
    for dependency in required(wheel).values():
        link(dependency, installation.packages)
    return installation


def required(wheel: Path) -> Mapping[str, Distribution]:
    """What a wheel needs, without extras, and what that needs, by name."""
    found: dict[str, Distribution] = {}
    seen: set[str] = set()
    waiting = [Requirement(text) for text in requirements_of(wheel)]
    while waiting:
        requirement = waiting.pop()
        if str(requirement) in seen or not applies(requirement):
            continue
        seen.add(str(requirement))
        dependency = distribution(requirement.name)
        assert requirement.specifier.contains(dependency.version, prereleases=True), requirement
        found[canonicalize_name(requirement.name)] = dependency
        waiting += further(dependency, requirement.extras)
    return found


def requirements_of(wheel: Path) -> list[str]:
    """The requirements in a wheel's metadata."""
    with ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        metadata, _ = parse_email(archive.read(name))
    return metadata.get("requires_dist", [])


def further(dependency: Distribution, extras: set[str]) -> Iterator[Requirement]:
    """What a distribution asks for, also for those of its extras that are wanted."""
    for text in dependency.requires or []:
        requirement = Requirement(text)
        if applies(requirement) or any(applies(requirement, extra=extra) for extra in extras):
            requirement.marker = None
            yield requirement


def applies(requirement: Requirement, *, extra: str = "") -> bool:
    """Whether a requirement is one here."""
    return requirement.marker is None or requirement.marker.evaluate({"extra": extra})


def link(dependency: Distribution, packages: Path) -> None:
    """Link a distribution's files, and leave its programs out."""
    for file in dependency.files or []:
        if ".." in file.parts or file.is_absolute() or "__pycache__" in file.parts:
            continue
        place = packages / file
        place.parent.mkdir(parents=True, exist_ok=True)
        place.symlink_to(dependency.locate_file(file))
