"""The figures of a fault: what was lost, what was refused, how long things took, what was said."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from tests.chaos.caller import ACTIVE, Caller
from tests.chaos.examined import Examined, examine
from tests.chaos.outages.client import Followed
from tests.chaos.outages.course import Course
from tests.chaos.outages.exchanges import NO_ANSWER, Exchange, counted
from tests.chaos.outages.notices import Notices
from tests.chaos.reference import Outcome
from tests.deployment import Deployment

PROBES = frozenset({"GET live", "GET ready", "GET metrics", "GET list"})
MOST_MESSAGES = 6
MESSAGE_LENGTH = 110
LEVEL = re.compile(r"\b(WARNING|ERROR|CRITICAL)\b(.*)")
VARYING = re.compile(r"[0-9a-f]{8}-[0-9a-f-]{27}|[0-9a-f]{16,}|\d+(?:\.\d+)*|(?<=\w)=\S+")


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """The figures of a run; those of the last group are to be nothing."""

    jobs: int
    identical: int
    fault_s: float
    requests: int
    refused: Mapping[str, int]
    slowest_s: Mapping[str, float]
    broken_streams: int
    further_attempts: int
    repeated_notices: int
    delay_beyond_s: float
    until_accepted_s: float
    until_ended_s: float
    until_busy_s: float
    until_ready_s: float
    until_all_ended_s: float
    not_ready: Mapping[str, int]
    metrics: Mapping[str, int]
    log_lines: int
    log_traces: int
    log_messages: Mapping[str, int]

    lost: int
    ended_otherwise: Mapping[str, int]
    wrong: int
    second_answers: int
    duplicated: int
    not_ended_once: int
    events_out_of_order: int
    notices_missing: int
    notices_of_two_ends: int
    unclean: Mapping[str, int]
    gave_up: Sequence[str]
    ended_unasked: int

    @property
    def faults(self) -> dict[str, object]:
        """What went wrong."""
        names = tuple(Figures.__slots__)
        return {
            name: value
            for name in names[names.index("lost") :]
            if (value := getattr(self, name)) not in (0, {}, [])
        }

    def lines(self) -> Iterator[str]:
        """The figures for people, one a line."""
        for name in Figures.__slots__:
            value = getattr(self, name)
            if name == "log_messages":
                yield "log_messages"
                yield from (f"  {count:5d} {text}" for text, count in value.items())
            else:
                shown = _rounded(value)
                yield f"{name:22s} {shown}"


def judge(
    deployment: Deployment, course: Course, notices: Notices, expected: Sequence[Outcome]
) -> Figures:
    """Ask the service about every job, and sum up what clients and probes have seen."""
    caller = Caller(deployment.address)
    try:
        found = {
            job.key: examine(caller, job.path, expected[job.which])
            for job in course.jobs
            if job.path
        }
        listed = caller.fits()
    finally:
        caller.close()
    known = [each for each in found.values() if each is not None]
    ids = [job.path.rpartition("/")[2] for job in course.jobs if job.path]
    told = notices.settled(ids)
    exchanges = course.exchanges
    lines = course.log.splitlines()
    return Figures(
        jobs=len(course.jobs),
        identical=sum(each.is_identical for each in known),
        fault_s=course.ended_at - course.began_at,
        requests=len(exchanges),
        refused=counted([e for e in exchanges if e.is_refused and e.what not in PROBES]),
        slowest_s=_slowest(exchanges),
        broken_streams=sum(job.broken_streams for job in course.jobs),
        further_attempts=sum(each.attempts - 1 for each in known),
        repeated_notices=told.repeated,
        delay_beyond_s=_delay_beyond_s(course),
        until_accepted_s=_first_after(course, (job.accepted_at for job in course.jobs)),
        until_ended_s=_first_after(course, (job.ended_at or 0.0 for job in course.jobs)),
        until_busy_s=course.busy_at - course.ended_at,
        until_ready_s=_until_ready_s(course),
        until_all_ended_s=_until_all_ended_s(course),
        not_ready=counted([e for e in exchanges if e.what == "GET ready" and e.status != 200]),
        metrics=counted([e for e in exchanges if e.what == "GET metrics" and e.status != 200]),
        log_lines=len(lines),
        log_traces=sum("Traceback (most recent" in line for line in lines),
        log_messages=_messages(lines),
        lost=_lost(course.jobs, found),
        ended_otherwise=Counter(
            each.state for each in known if each.state not in ("succeeded", *ACTIVE)
        ),
        wrong=sum(each.is_wrong for each in known),
        second_answers=course.second_answers,
        duplicated=len(listed) - len(set(ids)),
        not_ended_once=sum(each.ends != 1 for each in known)
        + sum(job.ends != 1 for job in course.jobs),
        events_out_of_order=sum(
            job.event_numbers != list(range(1, len(job.event_numbers) + 1)) for job in course.jobs
        ),
        notices_missing=told.missing,
        notices_of_two_ends=told.of_two_ends,
        unclean=counted([each for each in exchanges if _is_unclean(each)]),
        gave_up=course.gave_up,
        ended_unasked=deployment.ended_unasked,
    )


def _lost(jobs: Sequence[Followed], found: Mapping[str, Examined | None]) -> int:
    examined = (found.get(job.key) for job in jobs)
    return sum(each is None or each.state in ACTIVE for each in examined)


def _is_unclean(exchange: Exchange) -> bool:
    # A stream that breaks is resumed; how many did is a figure of its own.
    is_broken_stream = exchange.what == "events" and exchange.status == NO_ANSWER
    return not exchange.is_clean and not is_broken_stream


def _slowest(exchanges: Sequence[Exchange]) -> dict[str, float]:
    slowest: dict[str, float] = {}
    for each in exchanges:
        if each.what != "events" or each.is_refused:
            slowest[each.what] = max(slowest.get(each.what, 0.0), each.seconds)
    return slowest


def _delay_beyond_s(course: Course) -> float:
    """How much longer than undisturbed a job took at most, beside its share of the fault."""
    before = [
        job.ended_at - job.posted_at
        for job in course.jobs
        if job.ended_at is not None and job.ended_at < course.began_at
    ]
    usual_s = median(before) if before else 0.0
    return max(
        job.ended_at - job.posted_at - usual_s - _overlap_s(course, job.posted_at, job.ended_at)
        for job in course.jobs
        if job.ended_at is not None
    )


def _overlap_s(course: Course, began: float, ended: float) -> float:
    return max(0.0, min(ended, course.ended_at) - max(began, course.began_at))


def _first_after(course: Course, moments: Iterator[float]) -> float:
    return min((each for each in moments if each >= course.ended_at), default=0.0) - course.ended_at


def _until_ready_s(course: Course) -> float:
    """From the fault's end to the first of the answers that were no refusals to the last."""
    refused = [
        each.at + each.seconds
        for each in course.exchanges
        if each.what == "GET ready" and each.status != 200
    ]
    return max(0.0, max(refused, default=0.0) - course.ended_at)


def _until_all_ended_s(course: Course) -> float:
    """From the fault's end to the end of the last job posted before it."""
    ends = [job.ended_at or 0.0 for job in course.jobs if job.posted_at < course.ended_at]
    return max(0.0, max(ends, default=0.0) - course.ended_at)


def _messages(lines: Sequence[str]) -> dict[str, int]:
    """The commonest warnings and errors, without what differs from one to the next."""
    found = (LEVEL.search(line) for line in lines)
    texts = Counter(
        VARYING.sub("#", f"{match[1]}{match[2]}")[:MESSAGE_LENGTH] for match in found if match
    )
    return dict(texts.most_common(MOST_MESSAGES))


def _rounded(value: object) -> object:
    if isinstance(value, float):
        return f"{value:.1f}"
    if isinstance(value, Mapping):
        return ", ".join(f"{name}: {_rounded(each)}" for name, each in value.items()) or 0
    return value
