"""One fault, from an undisturbed service to the figures."""

from collections.abc import Sequence
from pathlib import Path

from tests.chaos.caller import Caller, Task
from tests.chaos.outages.course import Scene, undergo
from tests.chaos.outages.figures import Figures, judge
from tests.chaos.outages.notices import receiving_notices
from tests.chaos.outages.scenes import Fault
from tests.chaos.reference import Outcome
from tests.deployment import REAL, Commands

FITTED_WITHIN_S = 1_200.0


def tried(
    fault: Fault,
    tasks: Sequence[Task],
    expected: Sequence[Outcome],
    *,
    jobs: int,
    folder: Path,
    seconds: float | None = None,
    commands: Commands = REAL,
) -> Figures:
    """Set the scene, let it happen, and judge.

    The first task is a fit, made once in peace: from that one the run's derivations are derived.
    """
    with fault.scene(folder, commands) as scene, receiving_notices() as notices:
        parent = _fitted(scene, tasks[0])
        course = undergo(
            scene,
            notices.asked_for(tasks),
            parent=parent,
            jobs=jobs,
            fault_s=fault.seconds if seconds is None else seconds,
        )
        return judge(scene.deployment, course, notices, expected)


def _fitted(scene: Scene, task: Task) -> str:
    caller = Caller(scene.deployment.address)
    try:
        path = caller.post(task, key="parent")
        job = caller.ended(path, within_s=FITTED_WITHIN_S)
    finally:
        caller.close()
    assert job is not None, f"{path} did not end"
    assert job["state"] == "succeeded", job
    return path
