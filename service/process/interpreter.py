"""How processes of ours are started: by this interpreter, and from nothing that just lies there."""

import sys
from typing import Final

PYTHON: Final = (sys.executable, "-P")
"""``python -m`` alone looks for every module in the current folder first: an ``http.py`` in the
folder a service is started in would be run. With ``-P`` it does not; PYTHONPATH counts as ever."""

SAFE_PATH_VARIABLE: Final = "PYTHONSAFEPATH"
"""The same for processes whose command is not ours, and for those that they start."""
