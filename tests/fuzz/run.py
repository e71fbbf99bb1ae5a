"""Thousands of damaged inputs against a running service, and how it took them."""

import itertools
import json
import random
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import Any

import httpx

from tests.deployment import Deployment, Kind, wait_for
from tests.fuzz.products import FIT_ID, OTHER_FIT_ID, PRODUCT_ID, with_ids
from tests.fuzz.requests import KINDS
from tests.fuzz.sending import Answer, RawRequest, send
from tests.process_table import own_memory_mib
from tests.submissions import small_submissions

SENDERS = 4
LOOKS = 10
"""How often the memory of the API is looked at."""

READY_WITHIN_S = 900.0
ENDED_WITHIN_S = 1_200.0
MOST_FAULTS = 20

FAULTY_ENDS = (": fit-failed", ": fit-crashed", ": out-of-memory", "timed_out")
"""Faults of ours, or of a file that killed its process."""


@dataclass(slots=True, kw_only=True)
class Harvest:
    """What came back."""

    statuses: dict[str, Counter[int]] = field(
        default_factory=lambda: {kind: Counter() for kind in KINDS}
    )
    faults: list[str] = field(default_factory=list[str])
    memory_mib: list[float] = field(default_factory=list[float])
    jobs: Counter[str] = field(default_factory=Counter[str])
    fits_left: int = 0
    restarts: int = 0
    seconds: float = 0.0

    def lines(self) -> Iterator[str]:
        """The figures for people."""
        yield f"{'':18}  inputs  1-3xx    4xx    503  other 5xx  no answer due"
        for kind, statuses in self.statuses.items():
            groups = Counter[str]()
            for status, count in statuses.items():
                groups[_group(status)] += count
            yield (
                f"{kind:18} {statuses.total():7} {groups['fine']:6} {groups['4xx']:6} "
                f"{groups['503']:6} {groups['5xx']:10} {groups['none']:14}"
            )
        yield f"in all {sum(each.total() for each in self.statuses.values())} inputs"
        yield "accepted fits, and how they ended:"
        for how, count in sorted(self.jobs.items()):
            yield f"  {count:6} {how}"
        memory = " ".join(f"{each:.0f}" for each in self.memory_mib)
        yield f"memory of the API alone, MiB, at every tenth: {memory}"
        yield f"processes that ended unasked {self.restarts}, fits left {self.fits_left}"
        yield f"{self.seconds:.0f} s; faults: {len(self.faults)}"
        yield from self.faults[:MOST_FAULTS]


def fuzz(
    deployment: Deployment, *, inputs: int, seed: int, kinds: Sequence[str] = tuple(KINDS)
) -> Harvest:
    """Start the service, send everything, wait for the fits it accepted."""
    harvest = Harvest()
    began = time.monotonic()
    with httpx.Client(base_url=deployment.address, timeout=READY_WITHIN_S) as client:
        deployment.start()
        assert wait_for(lambda: _is_ready(client), within_s=READY_WITHIN_S), "not ready"
        ids = _something_to_make_of(client)
        # A fit's process ends by itself, when no other job of its owner follows.
        fits = deployment.of_kind(Kind.FIT)
        before = {each.pid for each in deployment.processes() if each not in fits}
        _send_all(deployment, harvest, ids, inputs, lambda number: made(number, seed, kinds))
        if not wait_for(lambda: _none_waits(client), within_s=ENDED_WITHIN_S):
            harvest.faults.append("not all accepted jobs ended")
        _account_for_fits(client, harvest)
        _erase_whole(client, harvest, f"/v1/fits/{ids[FIT_ID]}", f"products/{ids[PRODUCT_ID]}")
        wait_for(lambda: not deployment.of_kind(Kind.FIT), within_s=READY_WITHIN_S)
        harvest.fits_left = len(deployment.of_kind(Kind.FIT))
        harvest.restarts = len(before - {each.pid for each in deployment.processes()})
    deployment.stop()
    harvest.seconds = time.monotonic() - began
    return harvest


def made(number: int, seed: int, kinds: Sequence[str] = tuple(KINDS)) -> tuple[str, RawRequest]:
    """Input ``number`` of a seed among these kinds: the same whoever makes it, and whenever."""
    chance = random.Random(f"{seed}/{number}")
    kind = chance.choices(kinds, [KINDS[kind][1] for kind in kinds])[0]
    return kind, KINDS[kind][0](chance)


def _something_to_make_of(client: httpx.Client) -> dict[str, str]:
    """Fit a picture of a person twice, and pose a fit.

    Returns their ids by those that stand for them.
    """
    (picture,) = small_submissions(1)
    # With shading, so that there is an albedo to make a texture of.
    shaded = json.dumps(json.loads(picture.request) | {"cues": "SES"})
    files = replace(picture, request=shaded).files
    fits = [_succeeded(client, client.post("/v1/fits", files=files)) for _ in "12"]
    pose = client.post(f"/v1/fits/{fits[0]}/products", json={"kind": "pose"})
    return {
        FIT_ID: fits[0],
        OTHER_FIT_ID: fits[1],
        PRODUCT_ID: _succeeded(client, pose),
    }


def _succeeded(client: httpx.Client, answer: httpx.Response) -> str:
    path = answer.raise_for_status().headers["Location"]
    wait_for(
        lambda: client.get(path).json()["state"] not in {"queued", "running"},
        within_s=ENDED_WITHIN_S,
    )
    job = client.get(path).raise_for_status().json()
    assert job["state"] == "succeeded", job
    return job["id"]


def _none_waits(client: httpx.Client) -> bool:
    """Of fits and products alike, as the queue's figures say."""
    figures = client.get("/metrics").text.splitlines()
    waiting = [line for line in figures if line.startswith("maquette_queue_jobs")]
    return all(line.rpartition(" ")[2] in ("0", "0.0") for line in waiting)


def _erase_whole(client: httpx.Client, harvest: Harvest, path: str, below: str) -> None:
    """Products go with their fit."""
    client.delete(path).raise_for_status()
    left = client.get(f"{path}/{below}").status_code
    if left != httpx.codes.NOT_FOUND:
        harvest.faults.append(f"a product of {path}, erased, is answered by {left}")


def _send_all(
    deployment: Deployment,
    harvest: Harvest,
    ids: Mapping[str, str],
    inputs: int,
    make: Callable[[int], tuple[str, RawRequest]],
) -> None:
    numbers = itertools.count()
    lock = threading.Lock()
    (api,) = deployment.of_kind(Kind.API)

    def send_some() -> None:
        while (number := next(numbers)) < inputs:
            kind, request = make(number)
            answer = send(deployment.port, with_ids(request, ids))
            with lock:
                _note(harvest, number, kind, answer)
                if number % max(1, inputs // LOOKS) == 0:
                    harvest.memory_mib.append(own_memory_mib(api.pid))

    with ThreadPoolExecutor(SENDERS) as senders:
        # A sender that fails is a run that fails: its inputs would not have been sent.
        for sending in [senders.submit(send_some) for _ in range(SENDERS)]:
            sending.result()
    harvest.memory_mib.append(own_memory_mib(api.pid))


def _note(harvest: Harvest, number: int, kind: str, answer: Answer) -> None:
    harvest.statuses[kind][answer.status] += 1
    if answer.fault is not None:
        harvest.faults.append(f"input {number} ({kind}): {answer.fault}")


def _account_for_fits(client: httpx.Client, harvest: Harvest) -> None:
    following: str | None = "/v1/fits?limit=200"
    while following is not None:
        page = client.get(following).raise_for_status().json()
        for fit in page["fits"]:
            how = _how_it_ended(fit)
            harvest.jobs[how] += 1
            if how.endswith(FAULTY_ENDS):
                harvest.faults.append(f"{fit['links']['self']}: {fit['problem']}")
        following = page["next"]


def _how_it_ended(job: dict[str, Any]) -> str:
    problem = job["problem"]
    if problem is None:
        return job["state"]
    name = problem["type"].removeprefix("/problems/")
    return f"{job['state']}: {problem.get('code') or name}"


def _is_ready(client: httpx.Client) -> bool:
    try:
        return client.get("/healthz/ready").status_code == httpx.codes.OK
    except httpx.TransportError:
        return False


def _group(status: int) -> str:
    if status == 0:
        return "none"
    if status == 503:
        return "503"
    return "fine" if status < 400 else "4xx" if status < 500 else "5xx"
