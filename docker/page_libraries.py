"""The page's JavaScript libraries and its font, as CycloneDX lists them.

They are built into the page's scripts, where no package manager finds them. ``THIRD_PARTY.txt``,
which is built with the page, says which they are; the lock file has their licences and needs.
"""

import json
import re
import sys
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote

NOTICES: Final = Path("service/page/dist/THIRD_PARTY.txt")
LOCK: Final = Path("service/page/package-lock.json")
HEADING: Final = re.compile(r"^(\S+) (\S+)\n={10,}$", re.MULTILINE)

Listed = dict[str, Any]


def page_libraries() -> list[Listed]:
    """List what is built into the page, with versions and licences."""
    locked = _locked()
    return [
        {
            "bom-ref": _purl(name, version),
            "type": "library",
            **_named(name),
            "version": version,
            "purl": _purl(name, version),
            "licenses": [
                {"license": {"acknowledgement": "declared", "id": locked[name]["license"]}}
            ],
        }
        for name, version in _built_in(locked)
    ]


def page_dependencies() -> list[Listed]:
    """List which of them each needs."""
    locked = _locked()
    purls = {name: _purl(name, version) for name, version in _built_in(locked)}
    return [
        {
            "ref": purl,
            "dependsOn": [
                purls[each] for each in locked[name].get("dependencies", {}) if each in purls
            ],
        }
        for name, purl in purls.items()
    ]


def _built_in(locked: dict[str, Listed]) -> list[tuple[str, str]]:
    """Return names and versions; ends where the page was built of others than are locked."""
    found = HEADING.findall(NOTICES.read_text())
    for name, version in found:
        if locked.get(name, {}).get("version") != version:
            sys.exit(f"{NOTICES} names {name} {version}, and {LOCK} another version: make page")
    return found


def _locked() -> dict[str, Listed]:
    packages = json.loads(LOCK.read_text())["packages"]
    return {path.removeprefix("node_modules/"): each for path, each in packages.items()}


def _named(name: str) -> Listed:
    scope, _, plain = name.rpartition("/")
    return {"group": scope, "name": plain} if scope else {"name": plain}


def _purl(name: str, version: str) -> str:
    return f"pkg:npm/{quote(name)}@{version}"
