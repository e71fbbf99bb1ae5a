"""A short run of the fuzzer against the real service; ``python -m tests.fuzz`` is the long one."""

from pathlib import Path

from tests.deployment import Deployment
from tests.fuzz.run import fuzz

INPUTS = 150
SEED = 1859


def test_whatever_comes_in_is_answered_and_nothing_is_left(tmp_path: Path):
    deployment = Deployment(folder=tmp_path / "data", workers=0, settings={"max_crashes": 3})
    try:
        harvest = fuzz(deployment, inputs=INPUTS, seed=SEED)
    finally:
        deployment.end()
    told = "\n".join(harvest.lines())
    assert harvest.faults == [], told
    assert sum(statuses.total() for statuses in harvest.statuses.values()) == INPUTS
    assert harvest.jobs.total() > 0, f"no picture reached a decoder\n{told}"
    assert (harvest.fits_left, harvest.restarts) == (0, 0), told
    assert deployment.processes() == []
