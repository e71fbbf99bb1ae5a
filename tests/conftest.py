"""What holds of every test: which command runs it, when, and whether it may be skipped."""

import os
from collections.abc import Generator
from pathlib import Path
from typing import TypeVar

import pytest
from hypothesis import settings

from tests.parts import begins, has_none, is_of_shapes, is_rest
from tests.shared_data import NOT_SHIPPED

Report = TypeVar("Report", pytest.TestReport, pytest.CollectReport)

# Hypothesis' own profile for machines of which nothing is known: no example has a time limit,
# slow drawing is no fault, and every machine tries the same examples.
settings.load_profile("ci")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave files unread none of whose tests would run: reading all takes six seconds a process."""
    if not collection_path.name.startswith("test_"):
        return None
    return has_none(collection_path, config.option.markexpr) or None


@pytest.hookimpl(tryfirst=True)  # before pytest selects by the marker
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what `make test-rest` and `make test-shapes` run."""
    for item in items:
        slow = item.get_closest_marker("slow") is not None
        if is_rest(item.path, slow=slow):
            item.add_marker("rest")
        if is_of_shapes(item.path, slow=slow):
            item.add_marker("shapes")


@pytest.hookimpl(specname="pytest_collection_modifyitems", trylast=True)  # after they are shuffled
def order_of_files(items: list[pytest.Item]) -> None:
    """Put the longest files first."""
    items.sort(key=lambda item: begins(item.path))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    return _not_skipped((yield))


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    return _not_skipped((yield))


def _not_skipped(report: Report) -> Report:
    """The report; failed if something was skipped in CI, where everything that tests need is."""
    if os.environ.get("CI") == "true" and report.skipped and not hasattr(report, "wasxfail"):
        _, _, reason = report.longrepr
        if NOT_SHIPPED not in reason:
            report.outcome = "failed"
            report.longrepr = f"Where CI is true no test may be skipped. {reason}"
    return report
