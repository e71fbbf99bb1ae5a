"""Turns of owners who together ask for more than can be answered at a time.

This is start-time fair queueing, as jobs have it (:mod:`service.jobs.submit`), in which a question
costs the seconds that a process was busy with it. An owner has one answered at a time while others
wait, and of those the one comes first who has had the fewest seconds. Whoever comes anew begins
level with whom is being served: seconds that nobody waited for are not held against anybody.
"""

from collections import Counter
from typing import Generic, TypeVar

T = TypeVar("T")


class Turns(Generic[T]):
    """At most ``most`` questions that are being answered or wait; not thread-safe."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._waiting: list[tuple[str, T]] = []
        self._running: list[str] = []
        self._served_s = 0.0
        self._had_s: dict[str, float] = {}

    def join(self, owner: str, question: T) -> T | None:
        """Have a question wait; return the one that has no place: the last of who has most."""
        self._waiting.append((owner, question))
        if len(self._waiting) + len(self._running) <= self._most:
            return None
        count = Counter(each for each, _ in self._waiting)
        last = max(reversed(self._waiting), key=lambda each: count[each[0]])
        self._waiting.remove(last)
        return last[1]

    def begin(self) -> T | None:
        """Take the question whose turn it is from those that wait; None if none does."""
        if not self._waiting:
            return None
        first = min(self._waiting, key=lambda each: self._place(each[0]))
        self._waiting.remove(first)
        owner, question = first
        _, self._served_s = self._place(owner)
        self._had_s[owner] = self._served_s
        self._running.append(owner)
        return question

    def end(self, owner: str, seconds: float) -> None:
        """Count the seconds that a process was busy with a question of this owner."""
        self._running.remove(owner)
        self._had_s[owner] += seconds
        if not self._waiting and not self._running:
            self._served_s = 0.0
            self._had_s.clear()

    def _place(self, owner: str) -> tuple[int, float]:
        return self._running.count(owner), max(self._had_s.get(owner, 0.0), self._served_s)
