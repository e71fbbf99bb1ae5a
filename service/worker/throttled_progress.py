"""Reports of a child, stored no more often than somebody may want to read them."""

import time

from service.engine.port import Attempt, Directive, Report
from service.numerics.messages import ProgressMessage


class ThrottledProgress:
    """Keeps the latest report back until the last stored one is old enough."""

    def __init__(self, attempt: Attempt, *, interval_s: float) -> None:
        self._attempt = attempt
        self._interval_s = interval_s
        self._due = 0.0
        self._news: tuple[str, int | None] | None = None
        self._latest: ProgressMessage | None = None

    def take(self, message: ProgressMessage) -> None:
        """Take a report that came."""
        news = (message.stage, message.view)
        if news != self._news:
            # A new stage, or the next picture, is news: it does not wait.
            self._news = news
            self._due = 0.0
        self._latest = message

    def store_if_due(self) -> Directive | None:
        """Store the latest report, if there is one and it is time; then say whether to go on."""
        now = time.monotonic()
        if self._latest is None or now < self._due:
            return None
        directive = self._attempt.report(
            Report(
                stage=self._latest.stage,
                progress=min(max(self._latest.progress, 0.0), 1.0),
                energies=self._latest.energies,
                view=self._latest.view,
            )
        )
        self._latest = None
        self._due = now + self._interval_s
        return directive
