import contextlib
import functools
import logging
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import psycopg
import pytest

from tests.integration.service.harness import SHARED, Machine, Service, running_service
from tests.integration.service.receiver import Receiver, receiving
from tests.object_storage import CREDENTIALS, ObjectStorage, running_object_storage
from tests.postgres import fresh_database

DATABASES = ("sqlite", "postgres")


@contextlib.contextmanager
def fresh_machine(database: str, folder: Path) -> Iterator[Machine]:
    """A machine with nothing on it; skips where there is no server of its database."""
    if database == "sqlite":
        yield Machine(folder)
        return
    with contextlib.ExitStack() as stack:
        try:
            url = stack.enter_context(fresh_database())
        except psycopg.OperationalError as error:
            pytest.skip(f"no Postgres answers at 127.0.0.1:5432 ({error})")
        yield Machine(folder, database_url=url)


@pytest.fixture(autouse=True)
def _logs_go_where_they_went() -> Iterator[None]:
    """A command run in this process has DBOS log to what its test reads, and then closes."""
    dbos = logging.getLogger("dbos")
    before = dbos.handlers, dbos.propagate, dbos.filters
    yield
    dbos.handlers, dbos.propagate, dbos.filters = before


@pytest.fixture(params=DATABASES)
def machine(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Machine]:
    """A fresh machine, once with the embedded database and once with Postgres."""
    with fresh_machine(request.param, tmp_path) as fresh:
        yield fresh


@pytest.fixture(scope="package")
def started(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[str], Service]]:
    """Gives the service on a database, which is started when it is first asked for."""
    with contextlib.ExitStack() as stack:

        @functools.cache
        def start(database: str) -> Service:
            folder = tmp_path_factory.mktemp(database)
            fresh = stack.enter_context(fresh_machine(database, folder))
            return stack.enter_context(running_service(replace(fresh, settings=SHARED)))

        yield start


@pytest.fixture(params=DATABASES)
def either(request: pytest.FixtureRequest, started: Callable[[str], Service]) -> Service:
    """A service on each database, the same for all tests: who uses it leaves nothing running."""
    return started(request.param)


@pytest.fixture
def embedded(tmp_path: Path) -> Machine:
    """A fresh machine with the embedded database."""
    return Machine(tmp_path)


@pytest.fixture(scope="package")
def service(started: Callable[[str], Service]) -> Service:
    """The one on the embedded database: who uses it leaves nothing running."""
    return started("sqlite")


@pytest.fixture(scope="package")
def without_worker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """An API alone, of which nothing is set: who uses it leaves nothing waiting."""
    machine = Machine(tmp_path_factory.mktemp("without_worker"))
    with running_service(machine, api_only=True) as running:
        yield running


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    """Who the shared services may send notices to."""
    with receiving() as started:
        yield started


@pytest.fixture
def storage(monkeypatch: pytest.MonkeyPatch) -> Iterator[ObjectStorage]:
    """A fresh object storage, and its credentials in the environment."""
    for name, value in CREDENTIALS.items():
        monkeypatch.setenv(name, value)
    with running_object_storage() as running:
        yield running


@pytest.fixture
def no_fault_is_logged(caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    """What fails in a callback is told to nobody else."""
    yield
    faults = [record for record in caplog.get_records("call") if record.levelno >= logging.ERROR]
    assert [record.getMessage() for record in faults] == []
