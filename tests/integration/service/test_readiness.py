"""A service is ready before its worker has loaded the numerics; jobs wait until it has."""

from pathlib import Path

import pytest

from tests.integration.service.fake_preload import GATE
from tests.integration.service.harness import Machine, running_service


def test_jobs_wait_for_the_numerics_and_can_be_canceled_meanwhile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    gate = tmp_path / "gate"
    monkeypatch.setenv(GATE, str(gate))
    with running_service(Machine(tmp_path / "data")) as service:
        service.client.get("/v1/body-models").raise_for_status()
        waiting, given_up = service.submit(), service.submit()
        service.client.post(f"{given_up}/cancel").raise_for_status()
        assert service.ended(given_up)["state"] == "canceled"
        assert service.state(waiting) == "queued"
        gate.touch()
        assert service.ended(waiting)["state"] == "succeeded"


def test_a_service_that_has_not_loaded_the_numerics_stops_when_it_is_told_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv(GATE, str(tmp_path / "gate"))
    try:
        with running_service(Machine(tmp_path / "data", settings={"drain_s": 3600.0})) as service:
            service.submit()
        assert service.process.returncode == 0
    finally:
        (tmp_path / "gate").touch()
