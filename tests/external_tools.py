"""Programs and packages of others that a test needs: found or installed, or the test is skipped."""

import fcntl
import os
import shutil
import subprocess
from pathlib import Path

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


def installed(folder: Path) -> Path:
    """Install the locked packages unless they are there; skip where that cannot be done."""
    npm = shutil.which("npm")
    if npm is None or shutil.which("node") is None:
        pytest.skip("node and npm are not installed")
    stamp = folder / "node_modules" / ".package-lock.json"
    with (folder / "package-lock.json").open() as lock:
        # Tests of two processes may come for the same packages at once.
        fcntl.flock(lock, fcntl.LOCK_EX)
        if stamp.exists() and stamp.stat().st_mtime >= os.fstat(lock.fileno()).st_mtime:
            return folder
        done = subprocess.run([npm, "ci"], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        if os.environ.get("CI"):
            pytest.fail(done.stderr)
        pytest.skip(f"npm cannot install here: {done.stderr.strip()[-200:]}")
    return folder
