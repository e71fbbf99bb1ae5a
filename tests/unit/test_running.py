"""How tests are run: none is skipped in CI, arrays are checked."""

import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from jaxtyping import Float, TypeCheckError, jaxtyped

from tests.annotations import checked
from tests.parts import LONGEST, QUICK, TESTS


def test_every_definition_of_a_function_is_checked():
    for rows in (2, 3):

        @jaxtyped(typechecker=checked)
        def stacked(
            above: Float[np.ndarray, "n 2"], below: Float[np.ndarray, "n 2"], rows: int = rows
        ) -> Float[np.ndarray, "2*n 2"]:
            return np.concatenate([above, below])[: 2 * rows]

        right = np.zeros((rows, 2))
        assert len(stacked(right, right)) == 2 * rows
        with pytest.raises(TypeCheckError, match="parameters"):
            stacked(right, np.zeros((rows + 1, 2)))
        with pytest.raises(TypeCheckError, match="return value"):
            stacked(np.zeros((4, 2)), np.zeros((4, 2)))


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


@pytest.mark.parametrize("name", [*QUICK, *LONGEST])
def test_what_is_named_exists(name: str):
    assert (TESTS / name).exists()


MAKEFILE = (TESTS.parent / "Makefile").read_text()
OPTIONS = re.search(r"^CHECKED := (.+)$", MAKEFILE, re.MULTILINE)[1].split()

ANNOUNCED = """
import numpy as np
import pytest
from jaxtyping import TypeCheckError

from fitter.numerics import rotations
from fitter.parameters import BodyParameters

def body(pose=np.zeros((17, 3)), translation=np.zeros(3)):
    return BodyParameters(pose=pose, translation=translation, shape=np.zeros(4))

def test_an_array_of_another_shape_is_refused():
    with pytest.raises(TypeCheckError, match="parameter 'pose'"):
        body(pose=np.zeros((17, 2)))

def test_an_array_of_another_dtype_is_refused():
    with pytest.raises(TypeCheckError, match="parameter 'translation'"):
        body(translation=np.zeros(3, dtype=int))

def test_a_letter_that_means_two_lengths_is_refused():
    with pytest.raises(TypeCheckError, match="parameter 'second'"):
        rotations.compose(np.zeros((1, 3)), np.zeros((4, 3)))

def test_a_result_of_another_shape_is_refused(monkeypatch):
    monkeypatch.setattr(rotations.kernels, "composed", lambda *_: None)
    monkeypatch.setattr(np, "empty_like", lambda _: np.zeros((4, 2)))
    with pytest.raises(TypeCheckError, match="return value"):
        rotations.compose(np.zeros((4, 3)), np.zeros((4, 3)))
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "outcome"), [(OPTIONS, "4 passed"), ((), "4 failed")], ids=["on", "off"]
)
def test_what_is_announced_is_checked_where_the_option_says_so(
    options: Sequence[str], outcome: str, tmp_path: Path
):
    (tmp_path / "test_written.py").write_text(ANNOUNCED)
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:schemathesis", *options, "."],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(TESTS.parent)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert outcome in run.stdout
