"""Messages between children and those who ask them: what arrives is what was sent, or nothing."""

import threading
from collections.abc import Iterator
from multiprocessing import Pipe
from multiprocessing.connection import Connection

import pytest
from pydantic import ValidationError

from service.compute import messages
from service.compute.messages import DoneMessage, ProgressMessage, TaskMessage, receive, send
from service.jobs.records import Report

Ends = tuple[Connection, Connection]


@pytest.fixture
def ends() -> Iterator[Ends]:
    ours, theirs = Pipe()
    with ours, theirs:
        yield ours, theirs


def test_a_message_arrives_with_its_parts_by_name(ends: Ends):
    task = TaskMessage(task="fit", parts=("image", "mask"), log_context={"job": "1"})
    send(ends[0], task, [b"picture", b""])
    received = receive(ends[1])
    assert received.message == task
    assert received.parts == {"image": b"picture", "mask": b""}


def test_messages_without_parts_follow_one_another(ends: Ends):
    report = ProgressMessage(
        report=Report(stage="shading", progress=0.5, energies={"total": 1.0}, view=1)
    )
    for message in (report, DoneMessage()):
        send(ends[0], message)
    assert [receive(ends[1]).message for _ in range(2)] == [report, DoneMessage()]


def test_each_part_is_sent_before_the_next_one_is_made(ends: Ends):
    is_there = threading.Event()

    def parts() -> Iterator[bytes]:
        yield b"first"
        assert is_there.wait(60.0)
        yield b"second"

    task = TaskMessage(task="fit", parts=("a", "b"))
    sending = threading.Thread(target=send, args=(ends[0], task, parts()))
    sending.start()
    assert b"fit" in ends[1].recv_bytes()
    assert ends[1].recv_bytes() == b"first"
    is_there.set()
    assert ends[1].recv_bytes() == b"second"
    sending.join()


@pytest.mark.parametrize("sent", [b"", b"{}", b'{"kind":"greeting"}', b"\x80\x04N."])
def test_what_is_no_message_is_refused_and_never_unpickled(ends: Ends, sent: bytes):
    ends[0].send_bytes(sent)
    with pytest.raises(ValidationError):
        receive(ends[1])


def test_a_part_that_is_too_large_is_not_taken(ends: Ends, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(messages, "LARGEST_PART_BYTES", 100)
    send(ends[0], DoneMessage(parts=("file",)), [bytes(101)])
    with pytest.raises(OSError):  # noqa: PT011 - as the standard library raises it
        receive(ends[1])
