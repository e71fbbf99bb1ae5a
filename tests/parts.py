"""Which tests each command of the Makefile runs, and which files begin a run."""

from functools import cache
from pathlib import Path

TESTS = Path(__file__).parent

QUICK = (
    "unit",
    "contract",
    "e2e/test_demo.py",
)
"""Folders and files of which `make test` runs all but what is marked slow."""

LONGEST = (
    "contract/test_schemathesis.py",
    "integration/test_training.py",
    # What it makes, others of its folder use.
    "foreign/test_readers.py",
    "integration/service/test_paper_command.py",
    "e2e/test_installed_wheel.py",
    # With the folders after them, whose other files use the same services.
    "e2e/page/test_products.py",
    "e2e/test_readme.py",
    "e2e",
    "integration/service/test_outages.py",
    "integration/service/test_failures.py",
    "integration/service/test_products.py",
    "integration/service/test_webhooks.py",
    "integration/service/test_refused_start.py",
    "integration/service/test_chaos.py",
    "integration/service/test_full_disk.py",
    "integration/service/test_many_machines.py",
    "integration/service",
    "unit/accuracy/test_data.py",
    "unit/training/test_kept_populations.py",
    # Of `make test` and `make test-shapes`.
    "unit/fits/test_fit.py",
    "unit/optimizer/test_recovery.py",
    "unit/training/test_rig.py",
    "unit/service/test_bodies_of_fits.py",
    "unit/optimizer/test_free_space.py",
)
"""Files and folders that take longest: two processes then end at nearly the same time."""


@cache
def is_rest(file: Path, *, slow: bool) -> bool:
    """Whether a test of this file is left to `make test-rest`; else it is one of `make test`."""
    return slow or not any(file.is_relative_to(TESTS / each) for each in QUICK)


@cache
def is_of_shapes(file: Path, *, slow: bool) -> bool:
    """Whether `make test-shapes` runs it: a quick unit test of one of the fitter's packages."""
    units = TESTS / "unit"
    if slow or not file.is_relative_to(units):
        return False
    package = TESTS.parent / "fitter" / file.relative_to(units).parts[0]
    return (package / "__init__.py").exists()


def has_none(file: Path, command: str) -> bool:
    """Whether a file can be left unread by a command, which is told by its markers."""
    if command == "not rest":
        return is_rest(file, slow=False)
    of_shapes = is_of_shapes(file, slow=False)
    if command == "not shapes":
        return of_shapes and "mark.slow" not in file.read_text()
    return command == "shapes" and not of_shapes


@cache
def begins(file: Path) -> int:
    """The file's place in a run: those that take longest come first, the others as they are."""
    found = (at for at, name in enumerate(LONGEST) if file.is_relative_to(TESTS / name))
    return next(found, len(LONGEST))
