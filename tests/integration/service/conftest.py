import contextlib
from collections.abc import Iterator
from pathlib import Path

import psycopg
import pytest

from tests.integration.service.harness import Machine, Service, running_service
from tests.postgres import fresh_database


@pytest.fixture(params=["sqlite", "postgres"])
def machine(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Machine]:
    """A fresh machine, once with the embedded database and once with Postgres."""
    if request.param == "sqlite":
        yield Machine(tmp_path)
    else:
        with contextlib.ExitStack() as stack:
            try:
                url = stack.enter_context(fresh_database())
            except psycopg.OperationalError as error:
                pytest.skip(f"no Postgres answers at 127.0.0.1:5432 ({error})")
            yield Machine(tmp_path, database_url=url)


@pytest.fixture
def embedded(tmp_path: Path) -> Machine:
    """A fresh machine with the embedded database."""
    return Machine(tmp_path)


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """One service for all the tests of a module that leave it as it was."""
    with running_service(Machine(tmp_path_factory.mktemp("service"))) as running:
        yield running
