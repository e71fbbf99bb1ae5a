"""The image, built with Debian's packages alone (debootstrap, buildah), and what lies in it."""

import json
import stat
import subprocess
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

REPOSITORY: Final = Path(__file__).parents[2]
SUITE: Final = "trixie"
BASE: Final = "localhost/maquette-base"
IMAGE: Final = "localhost/maquette"
BUILDAH: Final = ("buildah", "--storage-driver", "vfs")
"""Works where no overlay can be mounted."""


@dataclass(frozen=True)
class Image:
    """A built image, and a folder that holds its files."""

    root: Path
    container: str
    environment: dict[str, str]
    user: tuple[int, int]
    entrypoint: tuple[str, ...]

    def remove(self) -> None:
        """Give the folder back; the image stays."""
        buildah("umount", self.container)
        buildah("rm", self.container)


def buildah(*arguments: str) -> str:
    """Run buildah and return what it printed."""
    command = [*BUILDAH, *arguments]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.strip()


def build_base() -> None:
    """Make a base with Debian's Python, unless there is one from before."""
    if BASE in buildah("images", "--format", "{{.Name}}").split():
        return
    with TemporaryDirectory(prefix="maquette-base-") as folder:
        root = Path(folder) / "root"
        packages = "--include=python3,python3-venv,ca-certificates"
        subprocess.run(
            ["debootstrap", "--variant=minbase", packages, SUITE, root],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        for left in (*root.glob("var/cache/apt/**/*.*"), *root.glob("var/lib/apt/lists/*_*")):
            left.unlink()
        container = buildah("from", "scratch")
        buildah("add", "--quiet", container, str(root), "/")
        buildah("commit", "--quiet", container, BASE)
        buildah("rm", container)


def build_image(mounts: list[str]) -> None:
    """Build the Dockerfile; ``mounts`` are what pip needs to reach its packages here."""
    command = [*BUILDAH, "bud", "--isolation", "chroot", "--layers", "--format", "docker"]
    command += [argument for mount in mounts for argument in ("--volume", f"{mount}:ro")]
    command += ["--pull-never", "--build-arg", f"BASE_IMAGE={BASE}"]
    command += ["--ignorefile", "docker/Dockerfile.dockerignore", "--file", "docker/Dockerfile"]
    subprocess.run([*command, "--tag", IMAGE, "."], check=True, cwd=REPOSITORY)


def open_image() -> Image:
    """Lay out the image's files in a folder."""
    container = buildah("from", "--pull-never", IMAGE)
    described: dict[str, Any] = json.loads(buildah("inspect", "--type", "image", IMAGE))
    config = described["Docker"]["config"]
    user, group = (int(number) for number in config["User"].split(":"))
    return Image(
        root=Path(buildah("mount", container)),
        container=container,
        environment=dict(pair.split("=", 1) for pair in config["Env"]),
        user=(user, group),
        entrypoint=tuple(config.get("Entrypoint", ())),
    )


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
