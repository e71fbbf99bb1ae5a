"""Every Python process that finds this folder on its path finds no library that writes USDZ."""

import sys

sys.modules["pxr"] = None  # pyright: ignore[reportArgumentType]
