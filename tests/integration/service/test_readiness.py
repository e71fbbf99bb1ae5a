"""Ready is who can work: not before the numerics are loaded, nor while the database is locked."""

from collections.abc import Iterator
from pathlib import Path

import pytest
import sqlalchemy as sa

from service.jobs.database import open_database
from tests.integration.service.fake_preload import GATE
from tests.integration.service.harness import Machine, Service, eventually, running_service


@pytest.fixture
def gate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The file without which the fork server goes on loading; it is there in the end."""
    file = tmp_path / "gate"
    monkeypatch.setenv(GATE, str(file))
    yield file
    file.touch()


def test_jobs_wait_for_the_numerics_and_can_be_canceled_meanwhile(gate: Path, tmp_path: Path):
    machine = Machine(tmp_path / "data", settings={"worker_processes": 8})
    with running_service(machine, loads=False) as service:
        eventually(
            lambda: service.client.get("/v1/body-models").status_code == 200, what="a worker"
        )
        ready = eventually(lambda: said_of_the_worker(service), what="it is alive")
        assert "still loading" in ready
        # Between its becoming known and its first turn a worker may claim one job.
        claimed, waiting, given_up = (service.submit() for _ in range(3))
        service.client.post(f"{given_up}/cancel").raise_for_status()
        assert service.ended(given_up)["state"] == "canceled"
        assert "queued" in {service.state(claimed), service.state(waiting)}
        gate.touch()
        assert service.ended(waiting)["state"] == "succeeded"
        eventually(lambda: service.client.get("/healthz/ready").status_code == 200, what="ready")


def said_of_the_worker(service: Service) -> str:
    """What is told of a worker that is alive and not ready; empty while none is known to be."""
    answer = service.client.get("/healthz/ready")
    assert answer.status_code == 503
    assert answer.json()["code"] == "no-worker"
    told: str = answer.json()["detail"]
    return "" if told == "No worker is alive." else told


def test_a_service_that_has_not_loaded_the_numerics_stops_when_it_is_told_to(
    gate: Path, tmp_path: Path
):
    machine = Machine(tmp_path / "data", settings={"drain_s": 1.0})
    with running_service(machine, loads=False) as service:
        service.submit()
        assert not gate.exists()
    assert service.process.returncode == 0


def test_probes_are_answered_while_the_database_is_locked(tmp_path: Path):
    machine = Machine(tmp_path / "data")
    database = open_database(f"sqlite:///{machine.data_dir / 'maquette.sqlite'}", connections=1)
    with running_service(machine) as service:
        with database.connect() as connection:
            connection.execute(sa.text("BEGIN IMMEDIATE"))
            answer = eventually(
                lambda: (
                    (ready := service.client.get("/healthz/ready")).status_code == 503 and ready
                ),
                what="not ready",
            )
            assert answer.json()["code"] == "database-unavailable"
            # Answered before the database was: in the end that would be refused in other words.
            assert "has not answered" in answer.json()["detail"]
            assert service.client.get("/healthz/live").status_code == 200
            connection.rollback()
        eventually(
            lambda: service.client.get("/healthz/ready").status_code == 200, what="ready again"
        )
    database.dispose()
