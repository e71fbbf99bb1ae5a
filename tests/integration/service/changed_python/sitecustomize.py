"""A Python process that finds this folder on its path lacks modules, or has its wall clock wrong.

It lacks those that ``PYTHON_LACKS`` names. Its clock is wrong by as many seconds as the file that
``SHIFTED_CLOCK`` names says, at the moment of asking.
"""

import os
import sys
import time
from pathlib import Path

for _name in os.environ.get("PYTHON_LACKS", "").split():
    sys.modules[_name] = None  # pyright: ignore[reportArgumentType]

if "SHIFTED_CLOCK" in os.environ:
    _OFFSET = Path(os.environ["SHIFTED_CLOCK"])
    _true_time = time.time

    def _shifted_time() -> float:
        return _true_time() + float(_OFFSET.read_text() or 0.0)

    time.time = _shifted_time
