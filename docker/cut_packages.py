"""Erase what packages bring and a running service never reads, and print what that was worth.

``python3 cut_packages.py SITE_PACKAGES``. Other programs may need it; the image runs the service
alone. A fit (`python -m service.compute.kernels`) comes after this where the image is built.
"""

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Final

BYTES_PER_MB: Final = 1_000_000

SOURCES: Final = (".a", ".c", ".cpp", ".f90", ".h", ".hpp", ".pxd", ".pyx")
"""Of no use where nothing is compiled. Stubs (.pyi) stay: lazy-loader reads them."""

CLOUD_SERVICES: Final = frozenset({"s3", "signin", "sso", "sso-oidc", "sts"})
"""What botocore is asked for: the storage, and where credentials may come from."""

DETECTOR_EXTRAS: Final = ("libLiteRtWebGpuAccelerator.so", "aot", "tools", "vendors")
"""Of ai_edge_litert: other processors, and tools that make and convert networks."""


def main() -> None:
    """Erase in the folder that is named."""
    packages = Path(sys.argv[1])
    for what, found in (
        ("tests of packages", test_folders),
        ("sources and headers", sources),
        ("botocore's other services", other_services),
        ("ai_edge_litert for other processors", detector_extras),
    ):
        # Found only now: what lies in an erased folder is not erased again.
        paths = list(found(packages))
        size = sum(map(size_of, paths))
        for path in paths:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        print(f"{size / BYTES_PER_MB:8.1f} MB  {what}")


def test_folders(packages: Path) -> Iterator[Path]:
    """The outermost folders named tests."""
    for path in packages.rglob("tests"):
        if path.is_dir() and "tests" not in path.relative_to(packages).parts[:-1]:
            yield path


def sources(packages: Path) -> Iterator[Path]:
    """What is there to be compiled or linked."""
    for path in packages.rglob("*"):
        if path.suffix in SOURCES and path.is_file():
            yield path


def other_services(packages: Path) -> Iterator[Path]:
    """The descriptions of services that nobody asks for."""
    for path in packages.glob("botocore/data/*"):
        if path.is_dir() and path.name not in CLOUD_SERVICES:
            yield path


def detector_extras(packages: Path) -> Iterator[Path]:
    """What the detector's two networks do not run on."""
    for name in DETECTOR_EXTRAS:
        if (path := packages / "ai_edge_litert" / name).exists():
            yield path


def size_of(path: Path) -> int:
    """The bytes of a file, or of all files of a folder."""
    if not path.is_dir():
        return path.lstat().st_size
    return sum(each.lstat().st_size for each in path.rglob("*") if not each.is_dir())


if __name__ == "__main__":
    main()
