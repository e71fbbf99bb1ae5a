"""Every Python process that finds this folder on its path finds nothing that runs the detector."""

import sys

sys.modules["ai_edge_litert"] = None  # pyright: ignore[reportArgumentType]
