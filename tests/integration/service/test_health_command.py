"""``maquette health``, as a container engine asks it."""

import os
import signal
import subprocess
import threading
import time
from dataclasses import replace
from urllib.parse import urlsplit

import pytest

from service.cli import main
from service.commands import health as command
from service.settings import Settings
from tests.integration.service.harness import (
    PATIENCE_S,
    QUICK,
    Machine,
    Service,
    eventually,
    running_service,
    running_worker,
)

HEALTHY, UNHEALTHY = 0, 1


@pytest.fixture(autouse=True)
def _patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "TIMEOUT_S", PATIENCE_S)
    monkeypatch.setattr(command, "LATE_S", PATIENCE_S)


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
