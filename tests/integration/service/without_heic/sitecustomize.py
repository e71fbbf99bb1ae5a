"""Every Python process that finds this folder on its path finds no decoder of HEIC."""

import sys

sys.modules["pi_heif"] = None  # pyright: ignore[reportArgumentType]
