"""Examples of lists of files."""

from pathlib import PurePath
from typing import Any, Final

MEDIA_TYPES: Final = {
    ".csv": "text/csv",
    ".glb": "model/gltf-binary",
    ".html": "text/html",
    ".pdf": "application/pdf",
    ".png": "image/png",
    ".webp": "image/webp",
}


def files(**sizes: int) -> list[dict[str, Any]]:
    """List files by their names, ``__`` standing for the dot, and their sizes in bytes."""
    names = {name.replace("__", "."): size for name, size in sizes.items()}
    return [
        {
            "name": name,
            "media_type": MEDIA_TYPES[PurePath(name).suffix],
            "size": size,
            "sha256": "d749f854970d25e805a6f10b7ec3a75d2b0060b9eb3333653b6c95baa7a1608c",
        }
        for name, size in names.items()
    ]
