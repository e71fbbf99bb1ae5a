"""The order in which jobs are begun and questions answered, played through on a simulated clock."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.compute.turns import Turns
from service.jobs.submit import next_turn

ALICE, BOB, CAROL = "alice", "bob", "carol"
ALICES_PRODUCTS = "alice products"


@dataclass
class Played:
    """A queue as DBOS keeps it: lowest turn first, then first in first out."""

    slots: int = 1
    waiting: list[tuple[int, int, str]] = field(default_factory=list)
    running: list[tuple[int, int, str]] = field(default_factory=list)
    begun: list[tuple[str, int]] = field(default_factory=list)
    accepted: int = 0

    def submit(self, tenant: str, *, jobs: int = 1) -> None:
        for _ in range(jobs):
            of_tenant = {each for _, _, each in self.waiting if each[:3] == tenant[:3]}
            turns = [turn for turn, _, each in (*self.waiting, *self.running) if each == tenant]
            turn = next_turn(
                begun=max((turn for turn, _, _ in self.running), default=None),
                waiting=min((turn for turn, _, _ in self.waiting), default=None),
                own=max(turns, default=None),
                others=len(of_tenant - {tenant}),
            )
            self.accepted += 1
            self.waiting.append((turn, self.accepted, tenant))

    def begin(self) -> None:
        """Fill the slots."""
        while self.waiting and len(self.running) < self.slots:
            job = min(self.waiting)
            self.waiting.remove(job)
            self.running.append(job)
            self.begun.append((job[2], job[1]))

    def end_one(self) -> None:
        """End the job that was begun first, and begin what comes next."""
        self.running.pop(0)
        self.begin()

    def run_out(self) -> list[str]:
        """Who is begun from now on, until nothing waits."""
        before = len(self.begun)
        self.begin()
        while self.running:
            self.end_one()
        return [tenant for tenant, _ in self.begun[before:]]


def test_a_single_job_is_begun_before_all_that_another_tenant_has_waiting():
    queue = Played(slots=2)
    queue.submit(ALICE, jobs=60)
    queue.begin()
    queue.submit(BOB)
    assert queue.run_out()[0] == BOB


def test_two_tenants_whose_jobs_wait_are_begun_in_turns():
    queue = Played()
    queue.submit(ALICE, jobs=10)
    queue.submit(BOB, jobs=10)
    assert queue.run_out() == [ALICE, BOB] * 10


def test_who_sends_the_next_job_after_the_end_of_the_last_gets_every_other_turn():
    queue = Played()
    queue.submit(ALICE, jobs=10)
    queue.begin()
    for _ in range(4):
        queue.submit(BOB)
        queue.end_one()
        assert queue.begun[-1][0] == BOB
        queue.end_one()
        assert queue.begun[-1][0] == ALICE


STEPS = st.lists(st.one_of(st.sampled_from("abcde"), st.none()), max_size=120)
"""Somebody submits a job, or, where it is None, a running one ends."""


def played(steps: Iterable[str | None], slots: int) -> Iterator[Played]:
    """The queue after each step."""
    queue = Played(slots=slots)
    for tenant in steps:
        if tenant is not None:
            queue.submit(tenant)
            queue.begin()
        elif queue.running:
            queue.end_one()
        yield queue


@given(STEPS, st.integers(1, 4))
def test_the_jobs_of_a_tenant_are_begun_in_the_order_they_came_in(
    steps: list[str | None], slots: int
):
    *_, queue = Played(slots=slots), *played(steps, slots)
    queue.run_out()
    orders: dict[str, list[int]] = {}
    for tenant, number in queue.begun:
        orders.setdefault(tenant, []).append(number)
    assert all(order == sorted(order) for order in orders.values())
    assert len(queue.begun) == queue.accepted


@given(STEPS, st.integers(1, 4))
def test_nobody_is_overtaken_more_than_once_by_each_tenant_that_comes_later(
    steps: list[str | None], slots: int
):
    overtaken: dict[int, Counter[str]] = {}
    seen = 0
    for queue in played(steps, slots):
        for tenant, number in queue.begun[seen:]:
            for _, older, _ in (job for job in queue.waiting if job[1] < number):
                overtaken.setdefault(older, Counter())[tenant] += 1
        seen = len(queue.begun)
    # A tenant's first job in the queue: nobody may get ahead of it again and again.
    first = {number for number in overtaken if _was_first(steps, number)}
    assert all(count <= 1 for number in first for count in overtaken[number].values())


def _was_first(steps: list[str | None], number: int) -> bool:
    submitted = [step for step in steps if step is not None]
    return submitted[number - 1] not in submitted[: number - 1]


def test_fits_and_products_of_a_tenant_take_turns_among_those_of_others():
    queue = Played()
    for owner in (ALICES_PRODUCTS, ALICE, BOB):
        queue.submit(owner, jobs=4)
    order = queue.run_out()
    assert Counter(order[:10])[BOB] == 4
    assert order.index(ALICE) < 5
    assert Counter(order) == Counter({ALICES_PRODUCTS: 4, ALICE: 4, BOB: 4})


@dataclass(frozen=True)
class Question:
    """A question that keeps a process busy for so many seconds."""

    owner: str
    number: int
    seconds: float


class Asked:
    """Questions to so many processes, on a clock that moves from one answer to the next."""

    def __init__(self, *, processes: int = 1, most: int = 1_000) -> None:
        self.turns: Turns[Question] = Turns(most)
        self.processes = processes
        self.now = 0.0
        self.answering: list[tuple[float, Question]] = []
        self.begun: list[Question] = []
        self.asked = 0

    def ask(self, owner: str, *, seconds: float = 1.0, times: int = 1) -> list[Question]:
        """Ask so often; returns what is refused for it."""
        refused: list[Question] = []
        for _ in range(times):
            self.asked += 1
            out = self.turns.join(owner, Question(owner, self.asked, seconds))
            refused += [] if out is None else [out]
            self.begin()
        return refused

    def begin(self) -> None:
        while len(self.answering) < self.processes and (question := self.turns.begin()):
            self.answering.append((self.now + question.seconds, question))
            self.begun.append(question)

    def answer_one(self) -> Question:
        """The answer that is ready first; then the next is begun."""
        first = min(self.answering, key=lambda each: (each[0], each[1].number))
        self.answering.remove(first)
        self.now, question = first
        self.turns.end(question.owner, question.seconds)
        self.begin()
        return question

    def run_out(self) -> list[str]:
        """Who is answered, in that order, until nobody waits."""
        answered: list[str] = []
        while self.answering:
            answered.append(self.answer_one().owner)
        return answered


@pytest.mark.parametrize("processes", [1, 2])
def test_a_question_waits_for_one_of_another_owner_however_many_those_are(processes: int):
    asked = Asked(processes=processes)
    asked.ask(ALICE, seconds=10.0, times=12)
    asked.ask(BOB)
    asked.answer_one()
    assert asked.begun[-1].owner == BOB


def test_one_question_of_an_owner_is_answered_at_a_time_while_others_wait():
    asked = Asked(processes=3)
    for owner, times in ((ALICE, 9), (BOB, 5), (CAROL, 2)):
        asked.ask(owner, times=times)
    together: list[list[str]] = []
    while asked.answering:
        together.append(sorted(each.owner for _, each in asked.answering))
        for _ in range(len(asked.answering)):
            asked.answer_one()
    assert together == [
        [ALICE] * 3,  # nobody else had asked
        *[[ALICE, BOB, CAROL]] * 2,
        *[[ALICE, ALICE, BOB]] * 2,
        [BOB],
    ]


def test_questions_that_take_longer_have_fewer_turns():
    asked = Asked()
    asked.ask(ALICE, seconds=10.0, times=20)
    asked.ask(BOB, seconds=1.0, times=100)
    seconds: Counter[str] = Counter()
    while asked.now < 150.0:
        question = asked.answer_one()
        seconds[question.owner] += round(question.seconds)
        # The first of them was answered while nobody else had asked.
        assert abs(seconds[ALICE] - seconds[BOB]) <= 20


def test_seconds_that_nobody_waited_for_are_not_held_against_an_owner():
    asked = Asked()
    for _ in range(100):
        asked.ask(ALICE)
        asked.answer_one()
    asked.ask(BOB, times=3)
    asked.ask(ALICE, times=3)
    assert asked.run_out() == [BOB, ALICE, BOB, ALICE, BOB, ALICE]


def test_questions_of_one_owner_alone_are_answered_in_their_order_by_all_processes():
    asked = Asked(processes=2)
    asked.ask(ALICE, times=7)
    assert len(asked.answering) == 2
    asked.run_out()
    assert [each.number for each in asked.begun] == [1, 2, 3, 4, 5, 6, 7]


def test_who_fills_all_places_gives_way_with_the_last_question_and_then_nobody_does():
    asked = Asked(most=4)
    assert asked.ask(ALICE, times=4) == []
    # One is being answered, three wait: a fifth is refused, and another owner's is not.
    assert [each.number for each in asked.ask(ALICE)] == [5]
    assert [(each.owner, each.number) for each in asked.ask(BOB)] == [(ALICE, 4)]
    assert [(each.owner, each.number) for each in asked.ask(CAROL)] == [(ALICE, 3)]
    assert [each.owner for each in asked.ask(BOB)] == [BOB]
    assert asked.run_out() == [ALICE, BOB, CAROL, ALICE]


@given(st.lists(st.tuples(st.sampled_from("abc"), st.floats(0.0, 10.0)), max_size=60))
def test_every_question_is_answered_once_and_those_of_an_owner_in_their_order(
    questions: list[tuple[str, float]],
):
    asked = Asked(processes=2)
    for number, (owner, seconds) in enumerate(questions):
        asked.ask(owner, seconds=seconds)
        if number % 3 == 2:
            asked.answer_one()
    asked.run_out()
    for owner in "abc":
        numbers = [each.number for each in asked.begun if each.owner == owner]
        assert numbers == sorted(numbers)
    assert len(asked.begun) == len(questions)
