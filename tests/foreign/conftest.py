from pathlib import Path

import pytest

from tests.external_tools import installed
from tests.foreign.artifacts import made_in


@pytest.fixture(scope="session")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of every mesh file there is, the same for all test processes of a run."""
    base = tmp_path_factory.getbasetemp()
    # Each process of pytest-xdist has a folder of its own below the run's.
    run = base.parent if base.name.startswith("popen-") else base
    return made_in(run / "artifacts")


@pytest.fixture(scope="session")
def npm_readers() -> Path:
    """The folder from which the readers that come from npm are run."""
    return installed(Path(__file__).parent / "readers")
