"""Was anything lost, done twice, done wrongly or left behind? What is asked, and the answer."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

import sqlalchemy as sa

from service.jobs.database import open_database
from service.jobs.executions import WORKFLOW, client_of
from service.jobs.storage_identity import SCOPE as STORAGE_SCOPE
from service.jobs.tables import ERASURES, JOBS
from tests.chaos.caller import ACTIVE, Caller, Outcome, outcome
from tests.chaos.run import Course
from tests.deployment import Deployment, Kind, wait_for


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


OPEN = ("PENDING", "ENQUEUED", "DELAYED")
SETTLED_WITHIN_S = 600.0
LEFT_WITHIN_S = 120.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """The figures of a run; those of the second group are to be nothing."""

    jobs: int
    kills: Mapping[Kind, int]
    repeated_posts: int
    interrupted_jobs: int
    further_attempts: int
    longest_pause_s: float
    longest_wait_s: float
    seconds: float
    identical: int

    lost: int
    duplicated: int
    not_ended_once: int
    wrong: int
    ended_otherwise: Mapping[str, int]
    ended_unasked: int
    open_executions: int
    processes_left: int
    temporary_files: int
    unknown_scopes: int

    @property
    def faults(self) -> dict[str, object]:
        """What went wrong."""
        names = tuple(Verdict.__slots__)
        return {
            name: value
            for name in names[names.index("lost") :]
            if (value := getattr(self, name)) not in (0, {})
        }

    def lines(self) -> Iterator[str]:
        """The figures for people."""
        kills = ", ".join(f"{count} {kind.value}" for kind, count in self.kills.items())
        yield f"jobs accepted                    {self.jobs}"
        yield f"kill -9                          {sum(self.kills.values())} ({kills})"
        yield f"submissions repeated (same key)  {self.repeated_posts}"
        yield f"jobs interrupted                 {self.interrupted_jobs}"
        yield f"further attempts                 {self.further_attempts}"
        yield f"longest pause between attempts   {self.longest_pause_s:.1f} s"
        yield f"longest wait for an answer       {self.longest_wait_s:.1f} s"
        yield f"the run took                     {self.seconds:.0f} s"
        yield f"identical to the undisturbed one {self.identical} (all files, to the last byte)"
        yield f"lost                             {self.lost}"
        yield f"duplicated                       {self.duplicated}"
        yield f"not ended exactly once           {self.not_ended_once}"
        yield f"other result than undisturbed    {self.wrong}"
        yield f"ended without success            {dict(self.ended_otherwise) or 0}"
        yield f"processes that ended unasked     {self.ended_unasked}"
        yield f"executions still open            {self.open_executions}"
        yield f"processes left                   {self.processes_left}"
        yield f"temporary files left             {self.temporary_files}"
        yield f"folders of no known job          {self.unknown_scopes}"


def verdict(deployment: Deployment, course: Course, expected: Sequence[Outcome]) -> Verdict:
    """Ask the service, stop it, and look at what is left."""
    caller = Caller(deployment.address)
    try:
        listed = caller.fits()
        examined = [examine(caller, each.path, expected[each.which]) for each in course.accepted]
    finally:
        caller.close()
    database = open_database(_database_url(deployment), connections=2)
    wait_for(lambda: _open_executions(database) == 0, within_s=SETTLED_WITHIN_S)
    deployment.stop()
    # Helpers of processes that were killed notice it by a pipe that ends.
    wait_for(lambda: not deployment.processes(), within_s=LEFT_WITHIN_S)
    found = [each for each in examined if each is not None]
    states = Counter(each.state for each in found)
    fits = {each.path.partition("/products")[0] for each in course.accepted}
    result = Verdict(
        jobs=len(course.accepted),
        kills=dict(course.kills),
        repeated_posts=course.repeated_posts,
        interrupted_jobs=sum(each.attempts > 1 for each in found),
        further_attempts=sum(each.attempts - 1 for each in found),
        longest_pause_s=max(each.pause_s for each in found),
        longest_wait_s=course.longest_wait_s,
        seconds=course.seconds,
        identical=sum(each.is_identical for each in found),
        lost=sum(each is None or each.state in ACTIVE for each in examined),
        duplicated=len(listed) - len(fits),
        not_ended_once=sum(each.ends != 1 for each in found),
        wrong=sum(each.is_wrong for each in found),
        ended_otherwise={state: count for state, count in states.items() if state != "succeeded"},
        ended_unasked=deployment.ended_unasked,
        open_executions=_open_executions(database),
        processes_left=len(deployment.processes()),
        temporary_files=len(list(_blobs(deployment).rglob(".*"))),
        unknown_scopes=len(_scopes(deployment) - _known_scopes(database)),
    )
    database.dispose()
    return result


def _database_url(deployment: Deployment) -> str:
    return deployment.database_url or f"sqlite:///{deployment.folder / 'maquette.sqlite'}"


def _open_executions(database: sa.Engine) -> int:
    """How many jobs DBOS has as waiting or running."""
    client = client_of(database)
    return len(client.list_workflows(name=WORKFLOW, status=list(OPEN), load_input=False))


def _blobs(deployment: Deployment) -> Path:
    return deployment.folder / "blobs"


def _scopes(deployment: Deployment) -> set[str]:
    return {folder.name for folder in _blobs(deployment).glob("*/*")}


def _known_scopes(database: sa.Engine) -> set[str]:
    """Scopes of the storage itself, of jobs, and of submissions that wait for their erasure."""
    with database.connect() as connection:
        return {
            STORAGE_SCOPE,
            *connection.execute(sa.select(JOBS.c.id)).scalars(),
            *connection.execute(sa.select(ERASURES.c.scope)).scalars(),
        }
