import platform
import subprocess
import sys

import pytest

# A process of its own: the setting lasts for the process's life.
PROGRAM = """
import resource
import numpy as np
from service.worker.heap import keep_freed_memory

def faults():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(50):
        # Two, so that one lies at the heap's end and one does not.
        pictures = [np.ones((480, 640, 3), dtype=np.float32) for _ in range(2)]
        del pictures
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

faults()
by_default = faults()
assert keep_freed_memory()
faults()
print(by_default, faults())
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="the setting is glibc's own")
def test_freed_pictures_are_not_faulted_in_again():
    finished = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True
    )
    by_default, kept = map(int, finished.stdout.split())
    assert kept < by_default / 10
