"""What the fake worker's fork server loads: the fake pipeline, once the gate is open.

The gate is the file named by the environment variable of ``GATE``; without one it is open.
"""

import os
import time
from pathlib import Path

import tests.integration.service.fake_pipeline  # noqa: F401

GATE = "FAKE_PRELOAD_GATE"

while GATE in os.environ and not Path(os.environ[GATE]).exists():
    time.sleep(0.01)
