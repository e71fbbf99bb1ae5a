"""The documents' code, so that it can be run as it stands there."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
PAGES = "\n".join(path.read_text() for path in sorted((ROOT / "service" / "docs").rglob("*.md")))


def block(name: str, text: str = README + PAGES) -> str:
    """The one code block that README and pages, or another text, mark as tested under this name."""
    found = re.findall(rf"<!-- tested: {name} -->\n```\w+\n(.*?)```", text, re.DOTALL)
    assert len(found) == 1, f"{len(found)} tested blocks are called {name!r}"
    return found[0]
