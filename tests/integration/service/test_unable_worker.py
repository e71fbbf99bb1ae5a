"""A worker whose fork server dies time after time is alive, and not able to work."""

import pytest

from service.commands import health
from service.settings import Settings
from tests.integration.service.fake_preload import FAULT
from tests.integration.service.harness import (
    QUICK,
    Service,
    eventually,
    running_service,
    running_worker,
)

HEALTHY, UNHEALTHY = 0, 1


def gauge(service: Service, name: str) -> float:
    lines = service.client.get("/metrics").raise_for_status().text.splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith(f"{name} "))


def test_it_says_so_everywhere_and_begins_jobs_once_it_is_able(
    embedded, tmp_path, monkeypatch, capsys
):
    fault = tmp_path / "fault"
    fault.touch()
    monkeypatch.setenv(FAULT, str(fault))
    settings = Settings(data_dir=embedded.data_dir, **QUICK)
    with running_service(embedded, api_only=True) as service, running_worker(embedded):
        eventually(lambda: gauge(service, "maquette_workers") == 1.0, what="it is alive")
        assert gauge(service, "maquette_workers_able") == 0.0
        ready = service.client.get("/healthz/ready")
        assert (ready.status_code, ready.json()["code"]) == (503, "no-worker")
        assert "its log says what is wrong" in ready.json()["detail"]
        eventually(
            lambda: (
                health.worker_health(settings) == UNHEALTHY
                and "can start processes" in capsys.readouterr().err
            ),
            what="health --worker says so",
        )
        waiting = service.submit()
        assert service.state(waiting) == "queued"
        fault.unlink()
        eventually(lambda: gauge(service, "maquette_workers_able") == 1.0, what="it is able")
        assert health.worker_health(settings) == HEALTHY
        eventually(lambda: service.client.get("/healthz/ready").status_code == 200, what="ready")
        assert service.ended(waiting)["state"] == "succeeded"


@pytest.fixture(autouse=True)
def _patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(health, "LATE_S", 60.0)
