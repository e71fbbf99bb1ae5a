"""Alive, ready and able: probes, figures and maquette health."""

import os
import signal
import subprocess
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from service.cli import main
from service.commands import health as command
from service.settings import Settings
from tests.integration.service.fake_preload import FAULT, GATE
from tests.integration.service.harness import (
    PATIENCE_S,
    QUICK,
    Machine,
    Service,
    eventually,
    running_service,
    running_worker,
)


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


HEALTHY, UNHEALTHY = 0, 1


@pytest.fixture(autouse=True)
def _patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "TIMEOUT_S", PATIENCE_S)
    monkeypatch.setattr(command, "LATE_S", PATIENCE_S)


def gauge(service: Service, name: str) -> float:
    lines = service.client.get("/metrics").raise_for_status().text.splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith(f"{name} "))


def test_a_worker_that_cannot_start_processes_says_so_everywhere_until_it_is_able(
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
                command.worker_health(settings) == UNHEALTHY
                and "can start processes" in capsys.readouterr().err
            ),
            what="health --worker says so",
        )
        waiting = service.submit()
        assert service.state(waiting) == "queued"
        fault.unlink()
        eventually(lambda: gauge(service, "maquette_workers_able") == 1.0, what="it is able")
        assert command.worker_health(settings) == HEALTHY
        eventually(lambda: service.client.get("/healthz/ready").status_code == 200, what="ready")
        assert service.ended(waiting)["state"] == "succeeded"


def health(machine: Machine, monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    for name, value in machine.environment().items():
        monkeypatch.setenv(name, value)
    with pytest.raises(SystemExit) as ended:
        main(["health", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


def listening(service: Service) -> Machine:
    """The service's settings with the port its API has got."""
    port = urlsplit(str(service.client.base_url)).port
    machine = service.machine
    return replace(machine, settings={**machine.settings, "port": port})


def test_api_and_worker_are_healthy_while_both_run(either, monkeypatch):
    told = listening(either)
    assert health(told, monkeypatch) == HEALTHY
    assert health(told, monkeypatch, "--worker") == HEALTHY


def stop(worker: subprocess.Popen[str]) -> None:
    """Let no thread of it go on."""
    worker.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, worker.pid, os.WSTOPPED)


def test_a_beat_that_is_late_is_waited_for_and_one_that_does_not_come_is_not(
    embedded, monkeypatch, capsys
):
    settings = Settings(data_dir=embedded.data_dir, **QUICK)
    found: list[int] = []
    with running_service(embedded, api_only=True), running_worker(embedded) as worker:
        eventually(lambda: command.worker_health(settings) == HEALTHY, what="it has begun")
        stop(worker)
        asking = threading.Thread(target=lambda: found.append(command.worker_health(settings)))
        asking.start()
        time.sleep(5.0 * settings.heartbeat_s)
        worker.send_signal(signal.SIGCONT)
        asking.join()
        assert found == [HEALTHY]
        stop(worker)
        monkeypatch.setattr(command, "LATE_S", 0.0)
        assert command.worker_health(settings) == UNHEALTHY
        assert "no worker" in capsys.readouterr().err


def test_without_a_worker_neither_is_healthy_and_it_is_said_why(
    without_worker, monkeypatch, capsys
):
    assert without_worker.client.get("/healthz/live").status_code == 200
    assert without_worker.client.get("/v1/body-models").status_code == 503
    told = listening(without_worker)
    assert health(told, monkeypatch) == UNHEALTHY
    assert "503 no-worker" in capsys.readouterr().err
    assert health(told, monkeypatch, "--worker") == UNHEALTHY
    assert "no worker" in capsys.readouterr().err


def test_a_service_that_is_not_there_is_not_healthy(embedded, monkeypatch, capsys):
    nowhere = Machine(embedded.data_dir, settings={"port": 9})
    assert health(nowhere, monkeypatch) == UNHEALTHY
    assert "no answer" in capsys.readouterr().err
    assert health(nowhere, monkeypatch, "--worker") == UNHEALTHY


def test_a_worker_whose_database_is_away_is_not_healthy(embedded, monkeypatch, capsys):
    away = Machine(embedded.data_dir, database_url="postgresql://postgres@127.0.0.1:9/none")
    assert health(away, monkeypatch, "--worker") == UNHEALTHY
    assert "database" in capsys.readouterr().err
