"""The order in which workers begin the jobs of several tenants, on both databases."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
import sqlalchemy as sa

from service.jobs.keys import KeyRing
from service.jobs.tables import JOBS
from tests.integration.service.guarded_service import Guarded, opened
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    running_service,
    running_worker,
)


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


def test_turns_are_the_same_for_several_workers(guarded: Guarded, tmp_path: Path):
    gate, names = tmp_path / "gate", dict[str, str]()
    alice, bob = (guarded.caller(guarded.key(tenant)) for tenant in ("alice", "bob"))
    with running_worker(guarded.service.machine):
        paths = queue_up(alice, "alice", 8, gate, names)
        eventually(lambda: alice.state(paths[1]) == "running", what="both workers are busy")
        single = queue_up(bob, "bob", 1, gate, names)
        gate.touch()
        assert bob.ended(single[0])["state"] == "succeeded"
        for path in paths:
            assert alice.ended(path)["state"] == "succeeded"
        # It is claimed first or second. Until it begins, the other worker may end short ones: they
        # take as long as that moment. Without turns it would come last, after all eight.
        assert "bob 0" in begun(guarded, names)[2:6]
