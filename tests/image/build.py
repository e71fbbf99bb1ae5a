"""Build the image with Debian's packages alone: debootstrap for the base, buildah for the rest."""

import json
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
