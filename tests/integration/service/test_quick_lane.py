"""Questions to the children that answer at once, and over the socket to their owner."""

import os
import signal
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from api_schemas.questions import BodyEstimate, BodyRequest
from fitter.vocabulary.choices import Gender
from service.compute import lanes
from service.compute.fork_server import ForkServer
from service.compute.lanes import SOCKET, Ask, QuickLane, asking
from service.compute.messages import DoneMessage, ProblemMessage, Received, TaskMessage
from service.compute.questions import ANSWER, BODY, CONVERSION, FILE, QUESTION, BodyTask
from service.compute.tasks import child_setup
from service.process.supervisor import SupervisedProcess
from service.settings import Settings
from tests.integration.service.fake_answers import GATE, GLB
from tests.integration.service.fake_processes import command
from tests.integration.service.harness import (
    PATIENCE_S,
    REPOSITORY,
    eventually,
    is_running,
    started_anew,
)
from tests.process_table import processes_with

SETUP = child_setup(
    Settings(max_pixels=1_000_000), name="estimator", tasks="tests.integration.service.fake_answers"
)


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    monkeypatch.setattr(lanes, "READY_WITHIN_S", PATIENCE_S)
    monkeypatch.setattr(lanes, "ANSWER_WITHIN_S", PATIENCE_S)


@pytest.fixture(scope="module")
def gate(tmp_path_factory):
    """A file that lets go what waits at the gate, once it exists."""
    return tmp_path_factory.mktemp("lane") / "gate"


@pytest.fixture(scope="module")
def server(gate):
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv(GATE, str(gate))
        # One that runs already knows of no gate.
        server = started_anew(ForkServer(SETUP.tasks))
        server.begin_preloading()
        yield server


@pytest.fixture
def lane(server, gate):
    gate.unlink(missing_ok=True)
    lane = QuickLane(server, SETUP, children=2)
    yield lane
    for pid in estimators(gate):
        os.kill(pid, signal.SIGKILL)


def estimators(gate: Path) -> set[int]:
    return {each.pid for each in processes_with(GATE, gate) if each.name == SETUP.name}


def asked(lane: QuickLane, *, owner: str = "", with_glb: bool = False, **script: float) -> Received:
    request = BodyRequest(gender=Gender.MALE, measurements=dict(script))
    question = BodyTask(request=request, with_glb=with_glb).model_dump_json().encode()
    task = TaskMessage(task=BODY, owner=owner, parts=(QUESTION,))
    return lane.answer(task, {QUESTION: question})


def trouble(received: Received) -> str:
    assert isinstance(received.message, ProblemMessage)
    return received.message.problem.code


def answering_pid(lane: QuickLane, **script: float) -> int:
    received = asked(lane, **script)
    assert isinstance(received.message, DoneMessage), received.message
    estimate = BodyEstimate.model_validate_json(received.parts[ANSWER])
    return int(estimate.measurements[0].standard_error)


def pids(lane: QuickLane) -> set[int]:
    return {answering_pid(lane) for _ in range(4)}


def test_an_answer_comes_with_its_file_where_it_is_asked_for(lane):
    assert asked(lane, with_glb=True).parts[FILE] == GLB
    assert asked(lane).parts[FILE] == b""


def test_children_are_kept_and_called_estimators(lane, gate):
    assert pids(lane) == pids(lane) == estimators(gate)
    assert len(pids(lane)) == 2


def test_a_file_goes_along_with_a_question_however_large_it_is(lane):
    parts = {QUESTION: b'{"ending":"obj"}', FILE: bytes(20_000_000)}
    answer = lane.answer(TaskMessage(task=CONVERSION, parts=tuple(parts)), parts)
    assert answer.parts == {FILE: b"obj of 20000000 bytes"}


def test_a_question_at_fault_is_refused_with_its_field(lane):
    received = asked(lane, girth=3.0)
    assert isinstance(received.message, ProblemMessage)
    assert received.message.problem.field == "measurements.girth"
    assert received.message.problem.status == 422


@pytest.mark.parametrize("unknown", ["fault", "no such question"])
def test_a_fault_in_the_answer_leaves_the_child_as_it_was(lane, unknown):
    before = pids(lane)
    if unknown == "fault":
        assert trouble(asked(lane, fault=1.0)) == "estimator-failed"
    else:
        assert trouble(lane.answer(TaskMessage(task=unknown), {})) == "estimator-failed"
    assert pids(lane) == before


def test_a_question_that_kills_its_child_fails_alone_and_the_child_is_replaced(lane):
    before = pids(lane)
    for _ in range(3):
        assert trouble(asked(lane, segfault=1.0)) == "estimator-failed"
    after = pids(lane)
    assert len(after) == 2
    assert not any(is_running(pid) for pid in before - after)


def test_a_child_killed_between_questions_is_replaced_unnoticed(lane):
    before = pids(lane)
    for pid in before:
        os.kill(pid, signal.SIGKILL)
    # Not a zombie either: its threads may still hold the pipe.
    eventually(lambda: not any(Path(f"/proc/{pid}").exists() for pid in before), what="reaped")
    assert not pids(lane) & before


def test_a_question_that_takes_too_long_is_given_up_and_its_child_killed(lane, monkeypatch):
    before = pids(lane)
    with monkeypatch.context() as impatience:
        impatience.setattr(lanes, "ANSWER_WITHIN_S", 0.3)
        assert trouble(asked(lane, gate=1.0)) == "estimator-timeout"
    after = pids(lane)
    assert len(before & after) == 1
    assert not any(is_running(pid) for pid in before - after)


def test_as_many_are_answered_at_once_as_there_are_children_and_too_many_are_turned_away(
    lane, gate
):
    answers: list[Received] = []
    capacity = lanes.capacity(2)
    assert capacity == 2 * (1 + lanes.MOST_WAITING)
    callers = [
        threading.Thread(target=lambda: answers.append(asked(lane, gate=1.0)))
        for _ in range(capacity + 5)
    ]
    for caller in callers:
        caller.start()
    # Nobody is answered before the gate opens, so every place is taken and stays so.
    eventually(lambda: len(answers) == 5, what="those beyond the capacity were turned away")
    others: list[Received] = []
    other = threading.Thread(target=lambda: others.append(asked(lane, owner="other", gate=1.0)))
    other.start()
    eventually(lambda: len(answers) == 6, what="one gave way to the question of another owner")
    assert {trouble(each) for each in answers} == {"estimator-unavailable"}
    gate.touch()
    for caller in (*callers, other):
        caller.join()
    are_answered = [isinstance(each.message, DoneMessage) for each in (*answers, *others)]
    assert (sum(are_answered), are_answered[-1]) == (capacity, True)


COMMAND = command("estimators", "fake")
FOLDER = "MAQUETTE_DATA_DIR"

TASK = BodyTask(request=BodyRequest(gender=Gender.MALE), with_glb=True)
PARTS = {QUESTION: TASK.model_dump_json().encode()}


def asked_over(ask: Ask) -> Received:
    return ask(TaskMessage(task=BODY, parts=tuple(PARTS)), PARTS)


def answered(address: str) -> Received:
    """Ask until there is an answer: an owner's children may take longer than is waited for."""

    def answer() -> Received | None:
        received = asked_over(asking(address))
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


def test_an_owner_is_waited_for_a_while(address: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(lanes, "READY_WITHIN_S", 0.3)
    began = time.monotonic()
    assert_unavailable(asked_over(asking(address)))
    assert time.monotonic() - began >= 0.3


def test_an_owner_ends_with_its_standard_input_and_its_children_with_it(
    owner: subprocess.Popen[bytes], address: str, tmp_path: Path
):
    assert answered(address).parts[FILE] == GLB
    running = {each.pid for each in processes_with(FOLDER, tmp_path)}
    assert len(running) > 1
    assert owner.stdin is not None
    owner.stdin.close()
    owner.wait(PATIENCE_S)
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
        if " estimators " in each.command and each.parent == os.getpid()
    )
    orphans = {each.pid for each in processes_with(FOLDER, tmp_path)} - {pid}
    os.kill(pid, signal.SIGKILL)
    answered(address)
    eventually(lambda: not any(is_running(each) for each in orphans), what="its children ended")
    supervised.stop()
    eventually(lambda: not processes_with(FOLDER, tmp_path), what="all have ended")
