"""Every test belongs to one of the two commands, and in CI none is skipped."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.parts import LONGEST, QUICK, TESTS, has_none

WRITTEN = """
import pytest

def test_quick():
    pass

@pytest.mark.slow
def test_slow():
    pass

def test_without_what_it_needs():
    pytest.skip({reason!r})
"""


def run(folder: Path, *options: str, reason: str = "no such program", **variables: str):
    """Pytest on a file of its own, with what holds of every test here."""
    (folder / "test_written.py").write_text(WRITTEN.format(reason=reason))
    (folder / "pytest.ini").write_text("[pytest]\nmarkers =\n  slow: slow\n  rest: rest\n")
    environment = {name: value for name, value in os.environ.items() if name != "CI"}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-rs", "-p", "tests.conftest", *options, "."],
        cwd=folder,
        env=environment | {"PYTHONPATH": str(TESTS.parent)} | variables,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
def test_in_ci_it_fails_and_says_why(tmp_path: Path):
    done = run(tmp_path, CI="true")
    assert done.returncode == 1, done.stdout + done.stderr
    assert "no such program" in done.stdout
    assert "1 failed, 2 passed" in done.stdout


@pytest.mark.slow
def test_what_is_not_shipped_may_be_missing_in_ci(tmp_path: Path):
    done = run(tmp_path, CI="true", reason="needs a file, which is not shipped")
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_what_one_command_leaves_the_other_runs(tmp_path: Path):
    # A file that is in none of the named folders is of the rest.
    quick, rest = run(tmp_path, "-m", "not rest"), run(tmp_path, "-m", "rest")
    assert "no tests ran" in quick.stdout
    assert "2 passed, 1 skipped" in rest.stdout
    assert "no such program" in rest.stdout


def test_files_that_are_left_unread_have_none():
    quick = TESTS / "unit" / "numerics" / "test_meshes.py"
    both = TESTS / "unit" / "population" / "test_body_estimate.py"
    rest = TESTS / "integration" / "test_distributions.py"
    unread = {
        command: [has_none(file, command) for file in (quick, both, rest)]
        for command in ("not rest", "rest", "shapes", "not shapes", "")
    }
    assert unread == {
        "not rest": [False, False, True],
        "rest": [False, False, False],
        "shapes": [False, False, True],
        "not shapes": [True, False, False],
        "": [False, False, False],
    }


@pytest.mark.parametrize("name", [*QUICK, *LONGEST])
def test_what_is_named_exists(name: str):
    assert (TESTS / name).exists()
