"""What goes wrong in a fit, in a worker, in the service: nothing is lost, everything is told."""

import os
import signal
import subprocess
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path

import pytest

from tests.integration.service.harness import (
    PATIENCE_S,
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
    running_worker,
)


def problem_of(service: Service, script: dict[str, object]) -> dict[str, object]:
    job = service.ended(service.submit(script))
    assert job["state"] == "failed"
    assert service.client.get(f"{job['links']['self']}/result").status_code == 409
    return job["problem"]


def test_a_fault_of_ours_is_told_without_its_trace(service: Service):
    problem = problem_of(service, {"fault": True})
    assert problem["type"] == "/problems/fit-failed"
    assert "a fault in the fake" not in str(problem)


def test_running_out_of_memory_is_told(service: Service):
    assert problem_of(service, {"exhaust_memory": True})["code"] == "out-of-memory"


def crashes(service: Service) -> float:
    figures = service.client.get("/metrics").text
    return float(figures.partition("\nmaquette_job_crashes ")[2].split()[0])


def test_a_picture_that_kills_its_process_is_given_up_after_three_times(
    service: Service, tmp_path: Path
):
    note = tmp_path / "pids"
    before = crashes(service)
    other = service.submit({"seconds": 0.1})
    problem = problem_of(service, {"segfault": True, "note_pid": str(note)})
    assert problem["type"] == "/problems/fit-crashed"
    # One more where it began in a process that had run another, which is not held against it.
    assert len(pids_noted(note)) in (3, 4)
    assert crashes(service) == before + 3
    assert service.ended(other)["state"] == "succeeded"


def test_a_fit_past_its_time_limit_is_stopped_and_the_service_when_told_to(tmp_path: Path):
    note = tmp_path / "pids"
    machine = Machine(tmp_path / "data", settings={"job_time_limit_s": 0.5})
    with running_service(machine) as service:
        script = {"seconds": 3600, "burn": True, "note_pid": str(note)}
        job = service.ended(service.submit(script))
        assert job["state"] == "timed_out"
        assert job["problem"]["type"] == "/problems/time-limit-exceeded"
        assert not any(is_running(pid) for pid in pids_noted(note))
        _stops_cleanly(service, signal.SIGINT)


def test_a_worker_restarted_by_its_supervisor_goes_on(service: Service, tmp_path: Path):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    path = service.submit({"gate": str(gate), "note_pid": str(note)})
    (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")
    worker = _worker_of(service.process.pid)
    os.kill(worker, signal.SIGKILL)
    eventually(lambda: not is_running(pid), what="the fit dies with its worker")
    gate.touch()
    job = service.ended(path)
    assert job["state"] == "succeeded"
    assert job["attempt"] == 2


def test_killing_the_service_ends_its_worker_and_the_fit(embedded: Machine, tmp_path: Path):
    note = tmp_path / "pids"
    machine = Machine(embedded.data_dir, settings={"drain_s": 0.0})
    with running_service(machine) as service:
        path = service.submit({"seconds": 3600, "note_pid": str(note)})
        (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")
        worker = _worker_of(service.process.pid)
        service.process.kill()
        service.process.wait()
        eventually(lambda: not is_running(worker), what="the worker ends")
        eventually(lambda: not is_running(pid), what="the fit ends")
    with running_service(machine) as service:
        eventually(lambda: len(pids_noted(note)) == 2, what="the fit runs again")
        assert service.client.post(f"{path}/cancel").status_code == 202
        assert service.ended(path)["state"] == "canceled"


@pytest.fixture(scope="module")
def api(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """An API whose workers are the tests' own."""
    machine = Machine(tmp_path_factory.mktemp("api"))
    with running_service(machine, api_only=True) as running:
        yield running


def worker_of(api: Service, **settings: object) -> AbstractContextManager[subprocess.Popen[str]]:
    return running_worker(replace(api.machine, settings=settings))


def test_a_stopping_worker_finishes_what_it_began(api: Service, tmp_path: Path):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    with worker_of(api, drain_s=PATIENCE_S) as worker:
        path = api.submit({"gate": str(gate), "note_pid": str(note)})
        eventually(lambda: pids_noted(note), what="the fit runs")
        waiting = api.submit({"seconds": 0.0})
        worker.send_signal(signal.SIGTERM)
        gate.touch()
        assert worker.wait(timeout=PATIENCE_S) == 0
    job = api.job(path)
    assert job["state"] == "succeeded"
    assert job["attempt"] == 1
    assert api.state(waiting) in ("queued", "succeeded")
    assert api.client.delete(waiting).status_code == 204


def test_a_stopping_worker_hands_back_what_it_cannot_finish(api: Service, tmp_path: Path):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    with worker_of(api, drain_s=0.1) as worker:
        path = api.submit({"gate": str(gate), "note_pid": str(note)})
        (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")
        worker.send_signal(signal.SIGTERM)
        assert worker.wait(timeout=PATIENCE_S) == 0
    assert api.state(path) == "queued"
    eventually(lambda: not is_running(pid), what="the fit ends")
    gate.touch()
    with worker_of(api):
        assert api.ended(path)["state"] == "succeeded"


def test_a_job_canceled_while_its_worker_is_dead_is_not_run_again(api: Service, tmp_path: Path):
    note = tmp_path / "pids"
    with worker_of(api) as worker:
        path = api.submit({"seconds": 3600, "note_pid": str(note)})
        eventually(lambda: pids_noted(note), what="the fit runs")
        worker.kill()
        worker.wait()
    assert api.client.post(f"{path}/cancel").status_code == 202
    with worker_of(api):
        assert api.ended(path)["state"] == "canceled"
    assert len(pids_noted(note)) == 1


def _stops_cleanly(service: Service, told: signal.Signals) -> None:
    worker = _worker_of(service.process.pid)
    service.process.send_signal(told)
    service.process.wait(timeout=PATIENCE_S)
    assert not is_running(worker)


def _worker_of(pid: int) -> int:
    """The one child of a service that is its worker; the others are estimators."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    (worker,) = (
        int(child)
        for child in children
        if b"\0worker\0" in Path(f"/proc/{child}/cmdline").read_bytes()
    )
    return worker
