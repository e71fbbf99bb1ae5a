"""One fault, from an undisturbed service to the figures."""

from collections.abc import Sequence
from pathlib import Path

from tests.chaos.outages.course import undergo
from tests.chaos.outages.figures import Figures, judge
from tests.chaos.outages.notices import receiving_notices
from tests.chaos.outages.scenes import Fault
from tests.chaos.reference import Outcome
from tests.deployment import REAL, Commands
from tests.submissions import Submission


def tried(
    fault: Fault,
    tasks: Sequence[Submission],
    expected: Sequence[Outcome],
    *,
    jobs: int,
    folder: Path,
    seconds: float | None = None,
    commands: Commands = REAL,
) -> Figures:
    """Set the scene, let it happen, and judge."""
    with fault.scene(folder, commands) as scene, receiving_notices() as notices:
        course = undergo(
            scene,
            notices.asked_for(tasks),
            jobs=jobs,
            fault_s=fault.seconds if seconds is None else seconds,
        )
        return judge(scene.deployment, course, notices, expected)
