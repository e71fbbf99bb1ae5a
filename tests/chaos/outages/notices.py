"""Who is told of the jobs' ends, and what it was told."""

import contextlib
import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from tests.deployment import wait_for
from tests.integration.service.receiver import Receiver, receiving
from tests.submissions import Submission

TOLD_WITHIN_S = 120.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """Jobs without a notice, jobs told of with two different ones, and repetitions of the same."""

    missing: int
    of_two_ends: int
    repeated: int


class Notices:
    """The notices of one run."""

    def __init__(self, receiver: Receiver) -> None:
        self._receiver = receiver

    def asked_for(self, tasks: Sequence[Submission]) -> list[Submission]:
        """The tasks, with a notice of each end."""
        return [self._with_notice(task) for task in tasks]

    def settled(self, job_ids: Sequence[str]) -> Told:
        """Wait for a notice of each job, and count."""
        wait_for(lambda: self._bodies().keys() >= set(job_ids), within_s=TOLD_WITHIN_S)
        bodies = self._bodies()
        return Told(
            missing=sum(job_id not in bodies for job_id in job_ids),
            of_two_ends=sum(len(set(each)) > 1 for each in bodies.values()),
            repeated=sum(len(each) - 1 for each in bodies.values()),
        )

    def _bodies(self) -> dict[str, list[bytes]]:
        bodies: defaultdict[str, list[bytes]] = defaultdict(list)
        for notice in list(self._receiver.notices):
            bodies[notice.headers["webhook-id"]].append(notice.body)
        return dict(bodies)

    def _with_notice(self, task: Submission) -> Submission:
        asked = json.loads(task.request) | {"webhook": {"url": self._receiver.url()}}
        return replace(task, request=json.dumps(asked))


@contextlib.contextmanager
def receiving_notices() -> Iterator[Notices]:
    """Receive while the context lasts."""
    with receiving() as receiver:
        yield Notices(receiver)
