"""Which tests `make test` runs and which `make test-rest`, and which files begin a run."""

from pathlib import Path

TESTS = Path(__file__).parent

QUICK = (
    "unit",
    "contract",
    "e2e/test_demo.py",
    "e2e/page/test_whole_path.py",
)
"""Folders and files of which `make test` runs all but what is marked slow."""

LONGEST = (
    "integration/test_training_command.py",
    "contract/test_schemathesis.py",
    "unit/training/test_kept_populations.py",
    "integration/service/test_failures.py",
    "integration/service/test_derivations.py",
    "integration/service/test_fits.py",
    "e2e/test_fuzz.py",
    "integration/service/test_full_disk.py",
    "integration/service/test_outages.py",
    "integration/service/test_many_machines.py",
    "integration/test_own_bodies.py",
    "e2e/page/test_derived.py",
    "integration/service/test_chaos.py",
    "unit/evaluation/test_data.py",
    # Of `make test`.
    "e2e/page/test_whole_path.py",
    "e2e/test_demo.py",
    "unit/training/test_knee_rings.py",
    "unit/training/test_bone_centres.py",
    "unit/service/test_derivers.py",
    "unit/optimizer/test_free_space.py",
    "unit/training/test_volume_learning.py",
)
"""Files that take longest, longest first: two processes then end at nearly the same time."""


def is_rest(file: Path, *, slow: bool) -> bool:
    """Whether a test of this file is left to `make test-rest`; else it is one of `make test`."""
    return slow or not any(file.is_relative_to(TESTS / each) for each in QUICK)


def begins(file: Path) -> int:
    """The file's place in a run: those that take longest come first, the others as they are."""
    return next((at for at, name in enumerate(LONGEST) if file == TESTS / name), len(LONGEST))
