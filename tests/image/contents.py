"""What lies in the image, and what its user may do there."""

import stat
import subprocess
from pathlib import Path
from typing import Final

from tests.image.build import Image

TOOLS: Final = ("gcc", "make", "git", "node", "npm", "ruff", "pyright", "pytest", "pip")
OURS: Final = "opt/maquette"


def size_mb(folder: Path) -> int:
    """The size of a folder, megabytes."""
    command = ["du", "--summarize", "--one-file-system", "--block-size=1MB", folder]
    return int(
        subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()[0]
    )


def tools(image: Image) -> list[str]:
    """The tools of building and developing that are found where the image looks for commands."""
    places = image.environment["PATH"].split(":")
    return [
        name
        for name in TOOLS
        if any((image.root / place.lstrip("/") / name).exists() for place in places)
    ]


def remains(image: Image) -> list[Path]:
    """Caches and sources that a build left behind."""
    left = [image.root / name for name in ("root/.cache", "build", "opt/pip")]
    return [path for path in left if path.exists()]


def not_sealed(image: Image) -> list[Path]:
    """Files of ours that someone other than root owns or may change."""
    return [
        path
        for path in (image.root / OURS).rglob("*")
        if not path.is_symlink()
        and (path.stat().st_uid != 0 or path.stat().st_mode & (stat.S_IWGRP | stat.S_IWOTH))
    ]


def writable(image: Image) -> list[str]:
    """The folders that the image's user might write in, were they not mounted read-only."""
    user, group = image.user
    command = ["chroot", f"--userspec={user}:{group}", "--groups=", image.root]
    command += ["find", "/", "-xdev", "-type", "d", "-writable"]
    found = subprocess.run(command, check=False, capture_output=True, text=True).stdout.split("\n")
    return sorted(path for path in found if path)
