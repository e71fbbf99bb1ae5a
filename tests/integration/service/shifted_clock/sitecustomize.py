"""Every Python process that finds this folder on its path has its wall clock wrong.

By as many seconds as the file named by ``SHIFTED_CLOCK`` says, at the moment of asking.
"""

import os
import time
from pathlib import Path

_OFFSET = Path(os.environ["SHIFTED_CLOCK"])
_true_time = time.time


def _shifted_time() -> float:
    return _true_time() + float(_OFFSET.read_text() or 0.0)


time.time = _shifted_time
