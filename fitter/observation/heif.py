"""HEIC, what phones take: whether its decoder is installed, and how it is used.

The decoder is libheif with libde265, in the package pi-heif, which only decodes. It turns the
picture as the container says, and rewrites EXIF's orientation to upright, so that nothing is turned
twice. Of ten bits it keeps the upper eight; of several pictures it opens the primary one.
"""

import importlib.util
from functools import cache
from typing import Final

from fitter.errors import InvalidInputError

PACKAGE: Final = "pi_heif"
FORMAT: Final = "HEIF"
"""Its name in Pillow."""

NOT_INSTALLED_CODE: Final = "heic-not-installed"
NOT_INSTALLED: Final = "HEIC pictures are not decoded here: the package pi-heif is not installed."
REMEDY: Final = (
    "Send a JPEG, or have the extra `heic` installed in this service: pip install 'maquette[heic]'."
)

BRANDS: Final = frozenset({b"heic", b"heix", b"heim", b"heis"})
"""Pictures coded with HEVC."""

MOST_BRANDS: Final = 100

ORIENTATION: Final = "original_orientation"
"""What EXIF said before the decoder rewrote it."""


def is_heif(data: bytes) -> bool:
    """Whether a file says that it holds pictures coded with HEVC."""
    if data[4:8] != b"ftyp":
        return False
    end = min(int.from_bytes(data[:4]), 16 + 4 * MOST_BRANDS)
    return not BRANDS.isdisjoint({data[8:12], *(data[at : at + 4] for at in range(16, end, 4))})


def decodes_heif() -> bool:
    """Whether the decoder is installed; it is not loaded."""
    return importlib.util.find_spec(PACKAGE) is not None


def ready_decoder(field: str) -> None:
    """Load the decoder and let Pillow know of it.

    Raises
    ------
    InvalidInputError
        ``heic-not-installed``, if there is none.
    """
    if not decodes_heif():
        raise InvalidInputError(
            code=NOT_INSTALLED_CODE, field=field, reason=NOT_INSTALLED, remedy=REMEDY
        )
    _register()


@cache
def _register() -> None:
    import pi_heif

    # Thumbnails and depth maps are not looked at. Jobs run side by side, a processor core each.
    pi_heif.register_heif_opener(
        thumbnails=False, depth_images=False, aux_images=False, decode_threads=1
    )
