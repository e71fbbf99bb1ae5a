"""Jobs that follow at once: in one process if they are one owner's, else in several."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from service.engine.keys import KeyRing
from tests.integration.service.guarded_service import Guarded, made, opened
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)

ONE_SLOT = {"worker_processes": 1}


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    """A service with one slot that asks for keys."""
    machine = Machine(
        tmp_path_factory.mktemp("kept"), settings=ONE_SLOT | {"authentication": "keys"}
    )
    with (
        opened(machine) as database,
        running_service(machine) as service,
        ExitStack() as clients,
    ):
        yield Guarded(service, KeyRing(database), database, clients)


class InARow:
    """Jobs of which each is waiting when the one before ends, and the processes they ran in."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._submitted: list[tuple[Service, str]] = []

    def submit(self, caller: Service, **script: object) -> None:
        number = len(self._submitted)
        gate = {} if number else {"gate": str(self._folder / "gate")}
        noted = {"note_pid": str(self._note(number))}
        self._submitted.append((caller, caller.submit({**gate, **noted, **script})))

    def states(self) -> list[str]:
        """Let them run; their states in the end."""
        (self._folder / "gate").touch()
        return [caller.ended(path)["state"] for caller, path in self._submitted]

    def pids(self, number: int) -> list[int]:
        """In which processes one of them was begun."""
        return pids_noted(self._note(number))

    def _note(self, number: int) -> Path:
        return self._folder / f"pids-{number}"


@pytest.fixture
def in_a_row(tmp_path: Path) -> InARow:
    return InARow(tmp_path)


def test_jobs_of_one_owner_are_run_by_one_process(guarded: Guarded, in_a_row: InARow):
    shop = guarded.caller(guarded.key())
    for _ in range(3):
        in_a_row.submit(shop)
    assert in_a_row.states() == ["succeeded"] * 3
    (pid,) = in_a_row.pids(0)
    assert in_a_row.pids(1) == in_a_row.pids(2) == [pid]
    eventually(lambda: not is_running(pid), what="it ends when no job comes")


def test_jobs_of_others_are_run_by_others(guarded: Guarded, in_a_row: InARow):
    shop = guarded.caller(guarded.key("shop"))
    browser = guarded.caller(made(shop).token)
    another = guarded.caller(made(shop).token)
    for caller in (shop, browser, another, guarded.caller(guarded.key("gym"))):
        in_a_row.submit(caller)
    assert in_a_row.states() == ["succeeded"] * 4
    assert len({pid for number in range(4) for pid in in_a_row.pids(number)}) == 4


@pytest.mark.parametrize("accident", ["fault", "exhaust_memory", "segfault"])
def test_what_ends_badly_after_another_job_is_run_again_in_a_new_process(
    guarded: Guarded, in_a_row: InARow, accident: str
):
    shop = guarded.caller(guarded.key())
    in_a_row.submit(shop)
    in_a_row.submit(shop, **{accident: True})
    in_a_row.submit(shop)
    assert in_a_row.states() == ["succeeded", "failed", "succeeded"]
    before, *alone = in_a_row.pids(1)
    assert [before] == in_a_row.pids(0)
    assert len(alone) == (3 if accident == "segfault" else 1)
    assert len({before, *alone, *in_a_row.pids(2)}) == len(alone) + 2


def test_after_what_a_caller_did_wrong_the_next_job_has_a_new_process(
    guarded: Guarded, in_a_row: InARow
):
    shop = guarded.caller(guarded.key())
    in_a_row.submit(shop, unusable=True)
    in_a_row.submit(shop)
    assert in_a_row.states() == ["failed", "succeeded"]
    assert in_a_row.pids(0) != in_a_row.pids(1)


def test_a_process_for_each_job_may_be_asked_for(tmp_path: Path, in_a_row: InARow):
    machine = Machine(tmp_path / "data", settings=ONE_SLOT | {"child_jobs": 1})
    with running_service(machine) as service:
        for _ in range(2):
            in_a_row.submit(service)
        assert in_a_row.states() == ["succeeded"] * 2
        assert in_a_row.pids(0) != in_a_row.pids(1)
