"""What a forked process is called where processes are listed: its command is another's."""

from contextlib import suppress
from pathlib import Path


def call_process(name: str) -> None:
    """Name this process, in at most 15 letters; where there is no ``/proc`` it keeps its name."""
    with suppress(OSError):
        Path("/proc/self/comm").write_text(name)
