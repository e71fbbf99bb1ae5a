"""Work done in a forked child, for what it leaves in files: its memory ends with it."""

import os
from collections.abc import Callable


def succeeds_in_child(work: Callable[[], object]) -> bool:
    """Do it in a child, of a process without threads; say whether it ended well."""
    child = os.fork()
    if child == 0:
        _do_and_end(work)
    _, status = os.waitpid(child, 0)
    return status == 0


def _do_and_end(work: Callable[[], object]) -> None:
    status = os.EX_SOFTWARE
    try:
        work()
        status = os.EX_OK
    finally:
        os._exit(status)
