"""A signal that comes at any moment of waiting ends it."""

import subprocess
import sys

WAITS_AND_IS_SIGNALLED = """
import signal, sys
from service.compute.worker import StopRequest

def stopped_at(step):
    # A wait during whose line number `step` a signal comes; or before which it came.
    stop = StopRequest()
    signal.signal(signal.SIGTERM, lambda *_: stop.ask())
    seen = 0
    def trace(frame, event, _):
        nonlocal seen
        if event == "line":
            seen += 1
            if seen == step:
                sys.settrace(None)
                signal.raise_signal(signal.SIGTERM)
        return trace
    if step == 0:
        signal.raise_signal(signal.SIGTERM)
    sys.settrace(trace)
    signal.setitimer(signal.ITIMER_REAL, 0.1)
    stop.wait()
    sys.settrace(None)

signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGTERM))
for step in range(12):
    stopped_at(step)
"""


def test_a_signal_at_any_line_of_the_wait_ends_it():
    subprocess.run([sys.executable, "-c", WAITS_AND_IS_SIGNALLED], timeout=60, check=True)


ASLEEP_BEFORE_THE_HANDLER_RUNS = """
import _thread, signal, threading
from service.compute.worker import StopRequest

stop = StopRequest()
signal.signal(signal.SIGTERM, lambda *_: stop.ask())
# Python notes the signal, and nothing wakes the main thread, which sleeps by then.
threading.Timer(0.3, lambda: _thread.interrupt_main(signal.SIGTERM)).start()
stop.wait()
"""


def test_a_signal_noted_just_before_the_wait_sleeps_ends_it():
    subprocess.run([sys.executable, "-c", ASLEEP_BEFORE_THE_HANDLER_RUNS], timeout=60, check=True)
