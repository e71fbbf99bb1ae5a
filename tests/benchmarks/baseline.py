"""The state of the project that speed is compared with, as a checkout of its own."""

import contextlib
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

REVISION = "2b22031"
"""Before fits, files and starts were made faster; the tag ``speed-baseline`` where it is set."""

HERE = Path(__file__).parents[2]


class NoBaselineError(Exception):
    """The revision cannot be had here; the message says why."""


@contextlib.contextmanager
def checkout(revision: str | Path = REVISION) -> Iterator[Path]:
    """A folder with that revision while the context lasts; a folder is taken as it is.

    Raises
    ------
    NoBaselineError
        If git does not have the revision, as in a shallow clone.
    """
    if Path(revision).is_dir():
        yield Path(revision).resolve()
        return
    with tempfile.TemporaryDirectory(prefix="maquette-baseline-") as folder:
        place = Path(folder) / "checkout"
        _git("worktree", "add", "--detach", str(place), str(revision))
        try:
            yield place
        finally:
            _git("worktree", "remove", "--force", str(place))


def _git(*arguments: str) -> None:
    try:
        subprocess.run(["git", *arguments], cwd=HERE, check=True, capture_output=True, text=True)
    except subprocess.CalledProcessError as error:
        raise NoBaselineError(error.stderr.strip()) from error
    except OSError as error:
        raise NoBaselineError(str(error)) from error
