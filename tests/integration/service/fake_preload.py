"""What the fake worker's fork server loads: the fake pipeline, once the gate is open.

The gate is the file named by the environment variable of ``GATE``; without one it is open. While
the file is there that the variable of ``FAULT`` names, whoever loads this dies.
"""

import os
import time
from pathlib import Path

import tests.integration.service.fake_pipeline  # noqa: F401
from service.compute import child

# Processes that compute are left variables of Python's.
GATE = "PYTHON_FAKE_PRELOAD_GATE"
FAULT = "PYTHON_FAKE_PRELOAD_FAULT"

while GATE in os.environ and not Path(os.environ[GATE]).exists():
    time.sleep(0.01)

if FAULT in os.environ and Path(os.environ[FAULT]).exists():
    os._exit(1)

# The fake pipeline writes its notes where tests read them.
child.confine = lambda **_: False
