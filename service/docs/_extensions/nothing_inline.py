"""The theme's scripts in files of their own, so that the service may forbid inline ones."""

import hashlib
import os
import re
from functools import partial
from pathlib import Path

from sphinx.application import Sphinx

INLINE = re.compile(r"<script>(.*?)</script>", re.DOTALL)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("build-finished", move_scripts)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def move_scripts(app: Sphinx, exception: Exception | None) -> None:
    if exception is not None or app.builder.format != "html":
        return
    root = Path(app.outdir)
    for page in root.rglob("*.html"):
        page.write_text(INLINE.sub(partial(_reference, page, root), page.read_text()))


def _reference(page: Path, root: Path, found: re.Match[str]) -> str:
    script = found[1]
    name = f"_static/inline-{hashlib.sha256(script.encode()).hexdigest()[:12]}.js"
    (root / name).write_text(script)
    return f'<script src="{os.path.relpath(root / name, page.parent)}"></script>'
