"""The order in which workers claim the jobs of several tenants."""

import contextlib

from service.jobs.attempts import AttemptLog
from service.jobs.claims import Claims
from service.jobs.database import open_database
from service.jobs.engine import JobEngine
from tests.integration.service.harness import Machine
from tests.integration.service.test_images import engine_of
from tests.integration.service.test_labels import accept
from tests.stored_jobs import ENDINGS


def queue_up(engine: JobEngine, tenant: str, count: int) -> None:
    for number in range(count):
        accept(engine, tenant, f"{tenant} {number}", tenant)


def test_tenants_take_turns_and_each_is_served_in_its_order(machine: Machine):
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    with contextlib.closing(engine_of(machine)) as engine:
        database = open_database(url)
        claims = Claims(database, executor_id="one", endings=ENDINGS)
        attempts = AttemptLog(
            database, executor_id="one", max_crashes=3, endings=ENDINGS, leave_slot=lambda _: None
        )
        queue_up(engine, "alice", 5)
        assert claims.take(1) == ["alice 0"]
        assert attempts.begin("alice 0") is not None
        queue_up(engine, "bob", 2)
        assert claims.take(9) == ["bob 0", "alice 1", "bob 1", "alice 2", "alice 3", "alice 4"]
        database.dispose()
