"""Random kill -9 of everything: every accepted job ends once, with its result, nothing is left.

The fake pipeline, so that it takes seconds; ``python -m tests.chaos`` does the same with real fits.
"""

import json

import pytest

from tests.chaos.caller import Outcome, Product, Task, references
from tests.chaos.run import Plan, disturb
from tests.chaos.verdict import verdict
from tests.deployment import Commands, Deployment, Kind
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.fake_processes import command
from tests.integration.service.harness import QUICK, REQUEST, Machine
from tests.submissions import Submission

COMMANDS = Commands(
    serve=command("serve"),
    worker=command("worker"),
)
PICTURES = 3
PRODUCTS = ("pose", "composition")
PLAN = Plan(
    jobs=15,
    kills={Kind.API: 1, Kind.WORKER: 2, Kind.FIT: 3, Kind.FORK_SERVER: 1},
    seed=20090929,
)


# So long that some of the kills hit a job.
SCRIPT = {"seconds": 0.8, "product": {"seconds": 0.1}}
FITS = tuple(
    Submission(image=scripted_image(SCRIPT | {"number": number}), request=json.dumps(REQUEST))
    for number in range(PICTURES)
)
TASKS: tuple[Task, ...] = (
    *FITS,
    *(Product(of=FITS[0], request={"kind": kind}) for kind in PRODUCTS),
)


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> list[Outcome]:
    """What each task's outcome is where nobody is killed, whatever the database."""
    undisturbed = Deployment(folder=tmp_path_factory.mktemp("undisturbed"), commands=COMMANDS)
    return references(undisturbed, TASKS)


def test_whoever_is_killed_every_job_ends_once_with_its_result(
    machine: Machine, expected: list[Outcome]
):
    settings = {**QUICK, "worker_processes": 1, "max_crashes": 1_000}
    deployment = Deployment(
        folder=machine.data_dir / "disturbed",
        commands=COMMANDS,
        database_url=machine.database_url,
        settings=settings,
    )
    try:
        deployment.start()
        judged = verdict(deployment, disturb(deployment, TASKS, PLAN), expected)
    finally:
        deployment.end()
    assert judged.faults == {}, (judged, deployment.log.read_text()[-10_000:])
    assert judged.jobs == PLAN.jobs
    assert judged.kills == PLAN.kills
    assert judged.further_attempts > 0, "no kill has hit a fit"
    assert judged.identical == PLAN.jobs
