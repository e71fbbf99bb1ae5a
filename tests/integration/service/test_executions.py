"""What is read of executions, on both databases: DBOS' own notes of jobs in every state."""

import threading
from collections.abc import Iterator

import pytest
import sqlalchemy as sa
from dbos import DBOSClient, DBOSPortableJSONSerializer
from sqlalchemy.exc import OperationalError

from service.jobs.database import open_database, prepare_database
from service.jobs.executions import APPLICATION, EXECUTION_VERSION, WORKFLOW, Executions, queue_of
from tests.integration.service.harness import PATIENCE_S, Machine

NOBODY = "postgresql://postgres@127.0.0.1:1/none"


@pytest.fixture
def database(machine: Machine) -> Iterator[sa.Engine]:
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    opened = open_database(url)
    yield opened
    opened.dispose()


def test_ended_and_waiting_executions_are_told_apart(database: sa.Engine):
    client = DBOSClient(
        system_database_engine=database,
        serializer=DBOSPortableJSONSerializer(),
        application_name=APPLICATION,
    )
    for job_id in ("waiting", "canceled", "another"):
        client.enqueue(
            {
                "workflow_name": WORKFLOW,
                "queue_name": queue_of("somebody"),
                "workflow_id": job_id,
                "app_version": EXECUTION_VERSION,
            },
            job_id,
        )
    client.cancel_workflow("canceled")
    client.cancel_workflow("another")
    executions = Executions(database)
    assert executions.ending("canceled") == "CANCELLED"
    assert executions.ending("waiting") is None
    assert executions.ending("unknown") is None
    assert executions.open() == 1
    assert executions.holders() == {}
    assert executions.held_by("anybody") == set()
    executions.remove(["waiting", "canceled"])
    assert executions.open() == 0
    assert executions.ending("canceled") is None
    assert executions.ending("another") == "CANCELLED"


def test_a_database_that_is_away_is_told_and_not_waited_for():
    executions = Executions(open_database(NOBODY))
    told: list[OperationalError] = []

    def look() -> None:
        with pytest.raises(OperationalError) as caught:
            executions.holders()
        told.append(caught.value)

    looking = threading.Thread(target=look, daemon=True)
    looking.start()
    looking.join(PATIENCE_S)
    assert told
