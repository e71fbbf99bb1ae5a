"""Every request of a run: what was answered, how cleanly and after how long."""

import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import httpx

PROBLEM = "application/problem+json"
WAIT = frozenset({429, 503, 507})
"""Statuses that tell a client to come again, which needs a Retry-After."""

NO_ANSWER = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Exchange:
    """One request; ``status`` is 0 if the connection broke or nothing came in time."""

    at: float
    what: str
    status: int
    seconds: float
    code: str
    is_clean: bool

    @property
    def is_refused(self) -> bool:
        """Whether the client was told to come again."""
        return self.status in WAIT


class Ledger:
    """Collects the exchanges of all threads of a run."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._exchanges: list[Exchange] = []

    def send(self, what: str, request: Callable[[], httpx.Response]) -> httpx.Response | None:
        """Make a request and note how it went; None if there was no answer."""
        began = time.monotonic()
        try:
            answer = request()
        except httpx.TransportError as error:
            self.note(began, what, NO_ANSWER, code=type(error).__name__, is_clean=False)
            return None
        self.note_answer(began, what, answer)
        return answer

    def note_answer(self, began: float, what: str, answer: httpx.Response) -> None:
        """Note an answer that has been read, to a request that began at a moment."""
        self.note(began, what, answer.status_code, code=_code(answer), is_clean=_is_clean(answer))

    def note(self, began: float, what: str, status: int, *, code: str, is_clean: bool) -> None:
        """Note a request that began at a moment of the monotonic clock and ends now."""
        exchange = Exchange(
            at=began,
            what=what,
            status=status,
            seconds=time.monotonic() - began,
            code=code,
            is_clean=is_clean,
        )
        with self._lock:
            self._exchanges.append(exchange)

    def all(self) -> list[Exchange]:
        """What was noted so far."""
        with self._lock:
            return list(self._exchanges)


def counted(exchanges: list[Exchange]) -> Mapping[str, int]:
    """How often each refusal or breach came: ``503 database-unavailable`` and so on."""
    return Counter(f"{each.status or 'no answer'} {each.code}".strip() for each in exchanges)


def _code(answer: httpx.Response) -> str:
    if not answer.headers.get("content-type", "").startswith(PROBLEM):
        return ""
    told = answer.json()
    return told.get("code") or told["type"].rpartition("/")[2]


def _is_clean(answer: httpx.Response) -> bool:
    if answer.status_code < 400:
        return True
    is_problem = answer.headers.get("content-type") == PROBLEM
    return is_problem and answer.status_code in WAIT and "Retry-After" in answer.headers
