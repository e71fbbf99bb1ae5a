"""A caller who does not give up, and what it makes of an undisturbed service, to compare with."""

import contextlib
import hashlib
import json
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import httpx

from tests.deployment import Deployment
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


FITTED_WITHIN_S = 1_200.0
TOLERANCE = 1e-6
"""Two processes may differ in the last digits of a sum, and a search carries them on to the ninth;
what goes wrong in a service is not so small."""
RESULT = "result.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What depends on the input alone: the digests of the files, and the result without times.

    ``is_whole`` says that every file is the one that the result lists.
    """

    files: Mapping[str, str]
    result: Mapping[str, Any]
    is_whole: bool

    def agrees_with(self, other: "Outcome") -> bool:
        """Say whether both are whole and tell the same, to within a number's last digits."""
        return self.is_whole and other.is_whole and _agree(self.result, other.result)


def references(deployment: Deployment, tasks: Sequence[Task]) -> list[Outcome]:
    """Do each once, on a service that is left in peace."""
    caller = Caller(deployment.address)
    try:
        deployment.start()
        paths = [caller.post(each, key=f"reference-{n}") for n, each in enumerate(tasks)]
        return [outcome(caller, _ended(caller, path)) for path in paths]
    finally:
        caller.close()
        deployment.end()


def outcome(caller: Caller, job: Mapping[str, Any]) -> Outcome:
    """Fetch everything a fit or a product that succeeded has left."""
    links = job["links"]
    files = {
        name: hashlib.sha256(caller.get(path).raise_for_status().content).hexdigest()
        for name, path in links["files"].items()
        if name != RESULT
    }
    if "result" in job:
        return Outcome(files=files, result=job["result"], is_whole=bool(files))
    result = json.loads(caller.get(links["result"]).raise_for_status().content)
    listed = {file["name"]: file["sha256"] for file in result.pop("files")}
    result.pop("stage_seconds", None)
    made = {name: digest for name, digest in files.items() if name in listed}
    return Outcome(files=made, result=result, is_whole=made == listed)


def _ended(caller: Caller, path: str) -> dict[str, Any]:
    job = caller.ended(path, within_s=FITTED_WITHIN_S)
    assert job is not None, f"{path} did not end undisturbed"
    assert job["state"] == "succeeded", job
    return job


def _agree(one: object, other: object) -> bool:
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_agree(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_agree, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=TOLERANCE, abs_tol=TOLERANCE)
    return one == other
