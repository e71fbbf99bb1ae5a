"""What a service that nobody disturbs makes of it, to compare with."""

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tests.chaos.caller import Caller, Task
from tests.deployment import Deployment

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
