"""A Postgres database that goes away and comes back, and what callers are told meanwhile."""

import contextlib
from collections.abc import Iterator

import httpx
from psycopg import sql

from tests.integration.service.harness import Machine
from tests.postgres import administration


@contextlib.contextmanager
def no_connections(machine: Machine) -> Iterator[None]:
    """Close all connections to the machine's own database, and refuse new ones."""
    assert machine.database_url is not None
    name = machine.database_url.rpartition("/")[2]
    allow = sql.SQL("ALTER DATABASE {} WITH ALLOW_CONNECTIONS {}")
    with administration() as connection:
        connection.execute(allow.format(sql.Identifier(name), sql.Literal(False)))
        connection.execute(
            "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = %s", [name]
        )
        try:
            yield
        finally:
            connection.execute(allow.format(sql.Identifier(name), sql.Literal(True)))


def assert_refused_for_now(answer: httpx.Response) -> None:
    assert answer.status_code == 503, answer.text
    assert answer.headers["Retry-After"]
    assert answer.json()["code"] == "database-unavailable"
