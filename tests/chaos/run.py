"""Jobs come in, processes are killed, jobs come out."""

import itertools
import random
import threading
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tests.chaos.caller import Caller, Task
from tests.deployment import Deployment, Kind

CALLERS = 3
MOST_OPEN = 3
"""How many jobs each caller has under way: enough to keep all busy, few enough that killing goes
on while there is something to kill."""

MISCHIEF_S = 1.5
"""A kill comes at most this long after its turn, at a moment drawn at random."""

MID_POST_S = 0.03
"""So long a submission takes: some kills of the API fall within one."""

LOOK_S = 0.02
ENDED_WITHIN_S = 1_200.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """How many jobs, and how many kills of each kind."""

    jobs: int
    kills: Mapping[Kind, int]
    seed: int


@dataclass(slots=True, kw_only=True)
class Accepted:
    """A job that was answered with 202, and which of the tasks it is."""

    key: str
    path: str
    which: int


@dataclass(slots=True, kw_only=True)
class Course:
    """How it went, as far as callers and the one who kills can tell."""

    accepted: list[Accepted] = field(default_factory=list[Accepted])
    kills: Counter[Kind] = field(default_factory=Counter[Kind])
    repeated_posts: int = 0
    longest_wait_s: float = 0.0
    seconds: float = 0.0


def disturb(deployment: Deployment, tasks: Sequence[Task], plan: Plan) -> Course:
    """Submit ``plan.jobs`` jobs and wait for their ends while processes are killed."""
    course = Course()
    began = time.monotonic()
    numbers = itertools.count()
    callers = [Caller(deployment.address) for _ in range(CALLERS)]
    threads = [
        threading.Thread(target=_submit, args=(caller, tasks, plan, numbers, course))
        for caller in callers
    ]
    for thread in threads:
        thread.start()
    _kill_by_turns(deployment, plan, course, callers, threads)
    while any(thread.is_alive() for thread in threads):
        deployment.keep_running()
        time.sleep(LOOK_S)
    for caller in callers:
        course.repeated_posts += caller.repeated_posts
        course.longest_wait_s = max(course.longest_wait_s, caller.longest_wait_s)
        caller.close()
    course.seconds = time.monotonic() - began
    return course


def _submit(
    caller: Caller,
    tasks: Sequence[Task],
    plan: Plan,
    numbers: "itertools.count[int]",
    course: Course,
) -> None:
    under_way: list[str] = []
    for number in numbers:
        if number >= plan.jobs:
            break
        which = number % len(tasks)
        key = f"chaos-{plan.seed}-{number}"
        path = caller.post(tasks[which], key=key)
        course.accepted.append(Accepted(key=key, path=path, which=which))
        under_way.append(path)
        if len(under_way) > MOST_OPEN:
            caller.ended(under_way.pop(0), within_s=ENDED_WITHIN_S)
    for path in under_way:
        caller.ended(path, within_s=ENDED_WITHIN_S)


def _kill_by_turns(
    deployment: Deployment,
    plan: Plan,
    course: Course,
    callers: Sequence[Caller],
    threads: Sequence[threading.Thread],
) -> None:
    chance = random.Random(plan.seed)
    turns = [kind for kind, count in plan.kills.items() for _ in range(count)]
    chance.shuffle(turns)
    for turn, kind in enumerate(turns):
        due = plan.jobs * (turn + 0.5) / len(turns)
        mischief_at = time.monotonic() + chance.uniform(0.0, MISCHIEF_S)
        while len(course.accepted) < due or time.monotonic() < mischief_at:
            deployment.keep_running()
            time.sleep(LOOK_S)
        if kind is Kind.API and chance.random() < 0.5:
            _await_a_post(callers, threads)
            time.sleep(chance.uniform(0.0, MID_POST_S))
        while not deployment.kill(kind, chance):
            deployment.keep_running()
            if not any(thread.is_alive() for thread in threads):
                return
            time.sleep(LOOK_S)
        course.kills[kind] += 1


def _await_a_post(callers: Sequence[Caller], threads: Sequence[threading.Thread]) -> None:
    while not any(caller.is_posting for caller in callers):
        if not any(thread.is_alive() for thread in threads):
            return
        time.sleep(0.001)
