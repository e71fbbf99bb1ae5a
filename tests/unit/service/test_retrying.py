import pytest
from sqlalchemy.exc import OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.compute.runner import retry_while_storage_is_away
from service.jobs.blobs import BlobsUnavailableError
from service.jobs.database import retry_while_database_is_away
from service.process import retrying

STATEMENT = "UPDATE"


class Database:
    def __init__(self, failures: int) -> None:
        self.failures = failures

    def write(self, value: int) -> int:
        if self.failures:
            self.failures -= 1
            raise OperationalError(STATEMENT, {}, Exception("database is locked"))
        return value


@pytest.fixture(autouse=True)
def _no_pauses(monkeypatch):
    monkeypatch.setattr(retrying.time, "sleep", lambda _: None)


def test_an_operation_is_repeated_until_the_database_is_back():
    assert retry_while_database_is_away(Database(5).write)(7) == 7


def test_an_operation_that_got_no_connection_is_repeated():
    failures = [PoolTimeoutError("QueuePool limit of size 8 overflow 0 reached")]

    def write() -> int:
        if failures:
            raise failures.pop()
        return 7

    assert retry_while_database_is_away(write)() == 7


def test_repeating_ends(monkeypatch):
    monkeypatch.setattr(retrying, "RETRY_FOR_S", 0.0)
    with pytest.raises(OperationalError):
        retry_while_database_is_away(Database(1).write)(7)


def test_other_errors_are_not_repeated():
    calls = []

    def broken() -> None:
        calls.append(1)
        raise KeyError

    with pytest.raises(KeyError):
        retry_while_database_is_away(broken)()
    assert len(calls) == 1


def test_a_storage_is_waited_for_as_a_database_is():
    failures = [BlobsUnavailableError("full"), BlobsUnavailableError("away")]

    def write(value: int) -> int:
        if failures:
            raise failures.pop()
        return value

    assert retry_while_storage_is_away(write)(7) == 7
