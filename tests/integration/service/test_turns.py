"""The order in which workers begin the jobs of several tenants."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
import sqlalchemy as sa

from service.jobs.database import open_database, prepare_database
from service.jobs.keys import KeyRing
from service.jobs.tables import JOBS
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    running_service,
)


@dataclass
class Guarded:
    """A service that asks for keys, and its database."""

    service: Service
    ring: KeyRing
    database: sa.Engine
    clients: ExitStack

    def caller(self, secret: str) -> Service:
        """The service as somebody with this key sees it."""
        client = httpx.Client(
            base_url=self.service.client.base_url,
            headers={"Authorization": f"Bearer {secret}"},
            timeout=self.service.client.timeout,
        )
        self.clients.enter_context(client)
        return Service(self.service.process, client, self.service.machine)

    def key(self, tenant: str = "shop") -> str:
        key = self.ring.create(tenant)
        caller = self.caller(key)
        eventually(lambda: caller.client.get("/v1/fits").status_code == 200, what="key known")
        return key


@contextmanager
def opened(machine: Machine) -> Iterator[sa.Engine]:
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url)
    yield database
    database.dispose()


@pytest.fixture
def guarded(machine: Machine) -> Iterator[Guarded]:
    """A service that asks for keys and begins one job at a time."""
    machine.settings = {"authentication": "keys", "worker_processes": 1}
    with (
        opened(machine) as database,
        running_service(machine) as service,
        ExitStack() as clients,
    ):
        yield Guarded(service, KeyRing(database), database, clients)


def begun(guarded: Guarded, names: dict[str, str]) -> list[str]:
    """The names of jobs in the order in which they were begun."""
    with guarded.database.connect() as connection:
        rows = connection.execute(sa.select(JOBS.c.id).order_by(JOBS.c.started_at)).scalars()
        return [names[each] for each in rows]


def queue_up(
    caller: Service, name: str, count: int, gate: Path, names: dict[str, str]
) -> list[str]:
    paths = [caller.submit({"gate": str(gate), "owner": name, "job": at}) for at in range(count)]
    for at, path in enumerate(paths):
        names[path.rpartition("/")[2]] = f"{name} {at}"
    return paths


@pytest.mark.parametrize("machine", ["sqlite"], indirect=True)
def test_tenants_take_turns_and_each_is_served_in_its_order(guarded: Guarded, tmp_path: Path):
    gate, names = tmp_path / "gate", dict[str, str]()
    alice, bob = (guarded.caller(guarded.key(tenant)) for tenant in ("alice", "bob"))
    paths = queue_up(alice, "alice", 5, gate, names)
    eventually(lambda: alice.state(paths[0]) == "running", what="the first job runs")
    paths += queue_up(bob, "bob", 2, gate, names)
    gate.touch()
    for path in paths[:5]:
        assert alice.ended(path)["state"] == "succeeded"
    for path in paths[5:]:
        assert bob.ended(path)["state"] == "succeeded"
    assert begun(guarded, names) == [
        *("alice 0", "bob 0"),
        *("alice 1", "bob 1"),
        *("alice 2", "alice 3", "alice 4"),
    ]
