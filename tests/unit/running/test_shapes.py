"""`make test-shapes` checks what `fitter` announces of its arrays, and nothing else does."""

import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.parts import TESTS

MAKEFILE = (TESTS.parent / "Makefile").read_text()
OPTIONS = re.search(r"^CHECKED := (.+)$", MAKEFILE, re.MULTILINE)[1].split()

WRITTEN = """
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
    (tmp_path / "test_written.py").write_text(WRITTEN)
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


def test_programs_load_no_checker():
    loaded = "import sys, fitter.library; sys.exit('beartype' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", loaded], check=False).returncode == 0
