"""A good client: keys its submissions, waits as it is told, follows events and resumes them."""

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import httpx

from tests.chaos.caller import ACTIVE
from tests.chaos.outages.exchanges import NO_ANSWER, Ledger
from tests.submissions import Submission

PATIENCE_S = 900.0
PAUSE_S = 1.0
POLL_S = 0.5
HANG_S = 120.0
"""A request that takes longer counts as not answered."""

SILENCE_S = 60.0
"""A stream that is silent for longer, though it sends a comment every 15 s, is given up."""


class GaveUpError(Exception):
    """There was no end of it."""


@dataclass(slots=True, kw_only=True)
class Followed:
    """A job as its client saw it; moments are of the monotonic clock."""

    key: str
    which: int
    posted_at: float
    path: str = ""
    accepted_at: float = 0.0
    ended_at: float | None = None
    ends: int = 0
    event_numbers: list[int] = field(default_factory=list[int])
    broken_streams: int = 0


class GoodClient:
    """One client with connections of its own."""

    def __init__(self, address: str, ledger: Ledger) -> None:
        self._ledger = ledger
        timeout = httpx.Timeout(HANG_S, connect=10.0)
        self._client = httpx.Client(base_url=address, timeout=timeout)

    def close(self) -> None:
        """Release the connections."""
        self._client.close()

    def post(self, task: Submission, *, key: str) -> str:
        """Submit until it is accepted; returns the job's path."""
        for _ in _until_given_up():
            answer = self._ledger.send("POST", lambda: self._posted(task, key))
            if answer is not None and answer.status_code == httpx.codes.ACCEPTED:
                return answer.headers["Location"]
            _wait_as_told(answer)
        raise GaveUpError(key)

    def poll(self, job: Followed) -> None:
        """Ask for the job until it has ended."""
        for _ in _until_given_up():
            answer = self._ledger.send("GET job", lambda: self._client.get(job.path))
            if answer is None or not answer.is_success:
                _wait_as_told(answer)
            elif answer.json()["state"] in ACTIVE:
                time.sleep(POLL_S)
            else:
                job.ended_at, job.ends = time.monotonic(), 1
                return
        raise GaveUpError(job.path)

    def follow(self, job: Followed) -> None:
        """Read the job's events to their end, resuming after the last one seen."""
        for _ in _until_given_up():
            began = time.monotonic()
            try:
                answer = self._read_events(job, began)
            except httpx.TransportError as error:
                self._ledger.note(
                    began, "events", NO_ANSWER, code=type(error).__name__, is_clean=False
                )
                job.broken_streams += 1
                answer = None
            if job.ends:
                return
            _wait_as_told(answer)
        raise GaveUpError(job.path)

    def _read_events(self, job: Followed, began: float) -> httpx.Response:
        seen = job.event_numbers[-1] if job.event_numbers else None
        headers = {} if seen is None else {"Last-Event-ID": str(seen)}
        timeout = httpx.Timeout(HANG_S, connect=10.0, read=SILENCE_S)
        path = f"{job.path}/events"
        with self._client.stream("GET", path, headers=headers, timeout=timeout) as answer:
            if not answer.is_success:
                answer.read()
                self._ledger.note_answer(began, "events", answer)
                return answer
            self._ledger.note(began, "events", answer.status_code, code="", is_clean=True)
            for number, kind in _events(answer.iter_lines()):
                job.event_numbers.append(number)
                if kind == "end":
                    job.ended_at = job.ended_at or time.monotonic()
                    job.ends += 1
        return answer

    def _posted(self, task: Submission, key: str) -> httpx.Response:
        headers = {"Idempotency-Key": key}
        return self._client.post("/v1/fits", files=task.files, headers=headers)


def _events(lines: Iterator[str]) -> Iterator[tuple[int, str]]:
    entry: dict[str, Any] = {}
    for line in lines:
        if line:
            name, _, value = line.partition(": ")
            entry[name] = value
            continue
        if "data" in entry:
            json.loads(entry["data"])
            yield int(entry["id"]), entry["event"]
        entry = {}


def _until_given_up() -> Iterator[None]:
    deadline = time.monotonic() + PATIENCE_S
    while time.monotonic() < deadline:
        yield


def _wait_as_told(answer: httpx.Response | None) -> None:
    told = None if answer is None else answer.headers.get("Retry-After")
    time.sleep(PAUSE_S if told is None else float(told))
