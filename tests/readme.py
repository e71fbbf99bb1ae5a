"""The README's code, so that it can be run as it stands there."""

import re
from pathlib import Path

README = (Path(__file__).parents[1] / "README.md").read_text()


def block(name: str) -> str:
    """The code block the README marks as tested under this name."""
    found = re.search(rf"<!-- tested: {name} -->\n```\w+\n(.*?)```", README, re.DOTALL)
    assert found, f"README.md has no tested block {name!r}"
    return found[1]
