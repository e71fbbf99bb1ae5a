"""What can be asked about one job after a run: its events, its end, its result."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from tests.chaos.caller import ACTIVE, Caller
from tests.chaos.reference import Outcome, outcome


@dataclass(frozen=True, slots=True, kw_only=True)
class Examined:
    """A job as the service tells of it, beside what was to come of it."""

    ends: int
    attempts: int
    pause_s: float
    state: str
    outcome: Outcome | None
    expected: Outcome

    @property
    def is_wrong(self) -> bool:
        """Whether its result is another than undisturbed."""
        return self.outcome is not None and not self.outcome.agrees_with(self.expected)

    @property
    def is_identical(self) -> bool:
        """Whether its files are the undisturbed ones to the last byte."""
        return self.outcome == self.expected


def examine(caller: Caller, path: str, expected: Outcome) -> Examined | None:
    """Ask for a job; None if there is none."""
    answer = caller.get(path)
    if answer.status_code != 200:
        return None
    job = answer.json()
    has_ended = job["state"] not in ACTIVE
    if "attempt" not in job:
        # A product, which has no events.
        return Examined(
            ends=int(has_ended),
            attempts=1,
            pause_s=0.0,
            state=job["state"],
            outcome=outcome(caller, job) if job["state"] == "succeeded" else None,
            expected=expected,
        )
    told = events(caller.get(f"{path}/events").text) if has_ended else []
    is_last = [kind == "end" for kind, _ in told]
    return Examined(
        # An end that is not the last event would be followed by more.
        ends=sum(is_last) if is_last and is_last[-1] else 0,
        attempts=job["attempt"],
        pause_s=_longest_pause_s(told),
        state=job["state"],
        outcome=outcome(caller, job) if job["state"] == "succeeded" else None,
        expected=expected,
    )


def events(text: str) -> list[tuple[str, dict[str, Any]]]:
    """Kind and data of each event of a stream."""
    found: list[tuple[str, dict[str, Any]]] = []
    for block in text.split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.splitlines() if ": " in line)
        if "data" in fields:
            found.append((fields["event"], json.loads(fields["data"])))
    return found


def _longest_pause_s(told: Sequence[tuple[str, Mapping[str, Any]]]) -> float:
    """How long the job stood still before an attempt other than its first began."""
    begins = [
        index
        for index, (kind, data) in enumerate(told)
        if kind == "state" and data["state"] == "running"
    ]
    moments = [datetime.fromisoformat(data["at"]) for _, data in told]
    pauses = [(moments[index] - moments[index - 1]).total_seconds() for index in begins[1:]]
    return max(pauses, default=0.0)
