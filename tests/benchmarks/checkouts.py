"""Another checkout of this repository: a folder that is there, or a revision in one of its own."""

import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

HERE = Path(__file__).parents[2]

BASELINE = "2b22031a2a8ab1638dfb10244a2302597710ede0"
"""The commit that goals of speed are shares of; ``speed-baseline`` where tags are."""


class NoCheckoutError(Exception):
    """A revision cannot be had; the message says why."""


@contextmanager
def checkout_of(wanted: str) -> Iterator[Path]:
    """The folder of this name; else the revision, in a folder that goes with the context.

    Raises
    ------
    NoCheckoutError
        If it is no folder, and git or this clone does not have the revision.
    """
    if Path(wanted).is_dir():
        yield Path(wanted).resolve()
        return
    commit = _commit(wanted)
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        checkout = Path(folder) / "checkout"
        _git("worktree", "add", "--detach", str(checkout), commit)
        try:
            yield checkout
        finally:
            _git("worktree", "remove", "--force", str(checkout))


def _commit(revision: str) -> str:
    try:
        return _git("rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
    except NoCheckoutError as error:
        message = f"{revision} is no folder, and no commit that can be had here ({error})"
        raise NoCheckoutError(message) from error


def _git(*arguments: str) -> str:
    try:
        finished = subprocess.run(
            ["git", "-C", str(HERE), *arguments],
            capture_output=True,
            check=True,
            text=True,
        )
    except OSError as error:
        message = f"git: {error.strerror}"
        raise NoCheckoutError(message) from error
    except subprocess.CalledProcessError as error:
        raise NoCheckoutError(error.stderr.strip()) from error
    return finished.stdout.strip()
