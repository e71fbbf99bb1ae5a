"""``maquette health``, as a container engine asks it."""

from urllib.parse import urlsplit

import pytest

from service.cli import main
from tests.integration.service.harness import Machine, Service, running_service

HEALTHY, UNHEALTHY = 0, 1


def health(machine: Machine, monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    for name, value in machine.environment().items():
        monkeypatch.setenv(name, value)
    with pytest.raises(SystemExit) as ended:
        main(["health", *arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code


def listening(machine: Machine, service: Service) -> Machine:
    """The machine's settings with the port its API has got."""
    port = urlsplit(str(service.client.base_url)).port
    return Machine(machine.data_dir, machine.database_url, {"port": port})


def test_api_and_worker_are_healthy_while_both_run(machine, monkeypatch):
    with running_service(machine) as service:
        told = listening(machine, service)
        assert health(told, monkeypatch) == HEALTHY
        assert health(told, monkeypatch, "--worker") == HEALTHY


def test_without_a_worker_neither_is_healthy_and_it_is_said_why(embedded, monkeypatch, capsys):
    with running_service(embedded, api_only=True) as service:
        told = listening(embedded, service)
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
