"""Print, out of the lock file, what the service in a container needs, with versions and hashes.

``python3 runtime_requirements.py pyproject.toml requirements.lock`` prints the project's
dependencies, the extras that a container is run with, and all that these need.
"""

import argparse
import re
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Final

EXTRAS: Final = ("s3", "detector", "heic")

PINNED: Final = re.compile(r"^(?P<name>[\w.-]+)==")
WANTED_BY: Final = re.compile(r"^    #(?: via)?\s+(?P<name>[\w.-]+)")


def main() -> None:
    """Print the part of the lock file that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("project", type=Path)
    parser.add_argument("lock", type=Path)
    parsed = parser.parse_args()
    entries = read_lock(parsed.lock.read_text())
    for name in needed(entries, direct(parsed.project)):
        print(entries[name].rstrip())


def direct(project_file: Path) -> list[str]:
    """Return the names of what the service in a container imports itself."""
    project = tomllib.loads(project_file.read_text())["project"]
    wanted = [*project["dependencies"]]
    for extra in EXTRAS:
        wanted += project["optional-dependencies"][extra]
    return [re.split(r"[^\w.-]", each, maxsplit=1)[0] for each in wanted]


def read_lock(text: str) -> dict[str, str]:
    """Return the lines of each package, by its name, with the comments on who wants it."""
    entries: dict[str, str] = {}
    name = ""
    for line in text.splitlines(keepends=True):
        if found := PINNED.match(line):
            name = normal(found["name"])
            entries[name] = ""
        if name:
            entries[name] += line
    return entries


def needed(entries: dict[str, str], roots: Iterable[str]) -> list[str]:
    """Return packages and all that they need, by the comments that pip-compile leaves."""
    needs: dict[str, list[str]] = {}
    for name, lines in entries.items():
        for line in lines.splitlines():
            if found := WANTED_BY.match(line):
                needs.setdefault(normal(found["name"]), []).append(name)
    found_so_far: set[str] = set()
    waiting = [normal(each) for each in roots]
    while waiting:
        name = waiting.pop()
        if name not in found_so_far:
            found_so_far.add(name)
            waiting += needs.get(name, [])
    return sorted(found_so_far)


def normal(name: str) -> str:
    """Write a package's name in the one way that names are compared in."""
    return re.sub(r"[-_.]+", "-", name).lower()


if __name__ == "__main__":
    main()
