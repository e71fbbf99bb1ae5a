"""Programs of others that a test needs: found, or the test is skipped with what to install."""

import shutil
import subprocess

import pytest


def found(program: str, *, package: str) -> str:
    """The path of a program; skips where it is not there."""
    path = shutil.which(program)
    if path is None:
        pytest.skip(f"{program} is not installed; Debian's package {package} has it")
    return path


def printed(*command: str) -> str:
    """What a program prints, which must succeed."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
