"""The wheel and the source distribution, built as they would be to be handed on."""

import subprocess
import sys
from pathlib import Path


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
