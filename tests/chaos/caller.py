"""A caller who does not give up: asks again, under the same key, until there is an answer."""

import contextlib
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import httpx

from tests.submissions import Submission

PATIENCE_S = 600.0
PAUSE_S = 0.1
ACTIVE = frozenset({"queued", "running"})


class NoAnswerError(Exception):
    """The service did not answer for minutes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Product:
    """A product of a fit of its own, so that it is made each time."""

    of: Submission
    request: Mapping[str, object]


Task = Submission | Product


class Caller:
    """One caller with connections of its own."""

    def __init__(self, address: str) -> None:
        self._client = httpx.Client(base_url=address, timeout=30.0)
        self.is_posting = False
        self.repeated_posts = 0
        self.longest_wait_s = 0.0

    def close(self) -> None:
        """Release the connections."""
        self._client.close()

    def post(self, task: Task, *, key: str) -> str:
        """Submit, however often it takes; returns the path of the fit or the product."""
        if isinstance(task, Product):
            fit = self.post(task.of, key=key)
            ended = self.ended(fit, within_s=PATIENCE_S)
            assert ended is not None, fit
            assert ended["state"] == "succeeded", ended
            return self._post(f"{fit}/products", json=dict(task.request))
        return self._post("/v1/fits", files=task.files, headers={"Idempotency-Key": key})

    def _post(self, path: str, **sent: Any) -> str:
        for attempt in self._attempts():
            self.repeated_posts += attempt > 0
            self.is_posting = True
            try:
                answer = self._client.post(path, **sent)
            except httpx.TransportError:
                continue
            finally:
                self.is_posting = False
            if answer.status_code != httpx.codes.SERVICE_UNAVAILABLE:
                assert answer.is_success, answer.text
                return answer.headers["Location"]
        raise NoAnswerError

    def get(self, path: str) -> httpx.Response:
        """Get, however often it takes."""
        for _ in self._attempts():
            with contextlib.suppress(httpx.TransportError):
                answer = self._client.get(path)
                if answer.status_code != httpx.codes.SERVICE_UNAVAILABLE:
                    return answer
        raise NoAnswerError

    def job(self, path: str) -> dict[str, Any]:
        """The job as it stands."""
        return self.get(path).raise_for_status().json()

    def ended(self, path: str, *, within_s: float) -> dict[str, Any] | None:
        """Wait for the job's end; None if it does not come."""
        deadline = time.monotonic() + within_s
        while (job := self.job(path))["state"] in ACTIVE:
            if time.monotonic() > deadline:
                return None
            time.sleep(PAUSE_S)
        return job

    def fits(self) -> list[dict[str, Any]]:
        """All fits there are."""
        found: list[dict[str, Any]] = []
        following: str | None = "/v1/fits?limit=200"
        while following is not None:
            page = self.get(following).raise_for_status().json()
            found += page["fits"]
            following = page["next"]
        return found

    def _attempts(self) -> Iterator[int]:
        began = time.monotonic()
        attempt = 0
        while time.monotonic() - began < PATIENCE_S:
            yield attempt
            attempt += 1
            self.longest_wait_s = max(self.longest_wait_s, time.monotonic() - began)
            time.sleep(PAUSE_S)
