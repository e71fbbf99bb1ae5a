"""Questions over the socket between an API and the process that owns the children."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from api_schemas.questions import BodyRequest
from fitter.vocabulary.choices import Gender
from service.compute import lanes
from service.compute.lanes import SOCKET, Ask, asking
from service.compute.messages import DoneMessage, ProblemMessage, Received, TaskMessage
from service.compute.questions import BODY, FILE, QUESTION, BodyTask
from service.process.supervisor import SupervisedProcess
from tests.integration.service.fake_answers import GLB
from tests.integration.service.harness import PATIENCE_S, REPOSITORY, eventually, is_running
from tests.process_table import processes_with

COMMAND = (sys.executable, "-m", "tests.integration.service.fake_estimators", "fake")
FOLDER = "MAQUETTE_DATA_DIR"

TASK = BodyTask(request=BodyRequest(gender=Gender.MALE), with_glb=True)
PARTS = {QUESTION: TASK.model_dump_json().encode()}


def asked(ask: Ask) -> Received:
    return ask(TaskMessage(task=BODY, parts=tuple(PARTS)), PARTS)


def answered(address: str) -> Received:
    """Ask until there is an answer: an owner's children may take longer than is waited for."""

    def answer() -> Received | None:
        received = asked(asking(address))
        return received if isinstance(received.message, DoneMessage) else None

    return eventually(answer, what="answered")


def assert_unavailable(received: Received) -> None:
    assert isinstance(received.message, ProblemMessage)
    assert received.message.problem.code == "estimator-unavailable"


@pytest.fixture
def address(tmp_path: Path) -> str:
    return str(tmp_path / SOCKET)


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    return os.environ | {FOLDER: str(tmp_path), "PYTHONPATH": str(REPOSITORY)}


@pytest.fixture
def owner(address: str, environment: dict[str, str]) -> Iterator[subprocess.Popen[bytes]]:
    """A process that answers questions and ends with its standard input."""
    process = subprocess.Popen([*COMMAND, address], env=environment, stdin=subprocess.PIPE)
    yield process
    process.kill()
    process.communicate()


@pytest.mark.usefixtures("owner")
def test_a_question_is_answered_with_its_file(address: str):
    assert answered(address).parts[FILE] == GLB


def test_an_owner_is_waited_for_a_while(address: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(lanes, "READY_WITHIN_S", 0.3)
    began = time.monotonic()
    assert_unavailable(asked(asking(address)))
    assert time.monotonic() - began >= 0.3


def test_an_owner_ends_with_its_standard_input_and_its_children_with_it(
    owner: subprocess.Popen[bytes], address: str, tmp_path: Path
):
    answered(address)
    running = {each.pid for each in processes_with(FOLDER, tmp_path)}
    assert owner.stdin is not None
    owner.stdin.close()
    owner.wait(PATIENCE_S)
    eventually(lambda: not any(is_running(pid) for pid in running), what="all have ended")


def test_children_end_with_an_owner_that_is_killed(
    owner: subprocess.Popen[bytes], address: str, tmp_path: Path
):
    answered(address)
    running = {each.pid for each in processes_with(FOLDER, tmp_path)}
    assert len(running) > 1
    owner.kill()
    owner.wait()
    eventually(lambda: not any(is_running(pid) for pid in running), what="all have ended")


def test_questions_are_answered_by_the_owner_that_is_started_after_one_that_was_killed(
    address: str, environment: dict[str, str], tmp_path: Path
):
    supervised = SupervisedProcess(
        [*COMMAND, address], name="estimators", environment=environment, stop_timeout_s=PATIENCE_S
    )
    answered(address)
    (pid,) = (
        each.pid
        for each in processes_with(FOLDER, tmp_path)
        if "fake_estimators" in each.command and each.parent == os.getpid()
    )
    os.kill(pid, signal.SIGKILL)
    answered(address)
    supervised.stop()
    eventually(lambda: not processes_with(FOLDER, tmp_path), what="all have ended")
