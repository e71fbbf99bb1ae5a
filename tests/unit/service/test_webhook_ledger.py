import time

import pytest
import sqlalchemy as sa

from api_schemas.jobs import JobState, WebhookState
from service.engine.database import open_database
from service.engine.records import end_job, find_job
from service.engine.tables import METADATA
from service.engine.webhooks import LEASE_MARGIN_S, WebhookLedger
from tests.stored_jobs import insert_job

TIME_LIMIT_S = 10.0


@pytest.fixture
def database(tmp_path):
    engine = open_database(f"sqlite:///{tmp_path}/jobs.sqlite")
    METADATA.create_all(engine)
    yield engine
    engine.dispose()


def ended(database: sa.Engine, *names: str, target: str | None = "0" * 64) -> None:
    """Enter jobs and end them."""
    with database.begin() as connection:
        for name in names:
            insert_job(
                connection,
                name,
                state="running",
                attempt=1,
                webhook_target=target,
                webhook_state="waiting" if target else None,
            )
            end_job(connection, name, state=JobState.SUCCEEDED, retention_s=1e6)


def later(monkeypatch, seconds: float) -> None:
    now = time.time()
    monkeypatch.setattr(time, "time", lambda: now + seconds)


def ledger(database: sa.Engine) -> WebhookLedger:
    return WebhookLedger(database, time_limit_s=TIME_LIMIT_S)


def webhook(database: sa.Engine, name: str):
    with database.connect() as connection:
        job = find_job(connection, name)
    assert job is not None
    return job.webhook


def test_a_notice_is_due_from_the_end_of_its_job_on_and_claimed_once(database):
    ended(database, "a", "b")
    ended(database, "untold", target=None)
    assert {due.job.id for due in ledger(database).claim(16)} == {"a", "b"}
    assert ledger(database).claim(16) == ()


def test_no_more_are_claimed_than_asked_for(database):
    ended(database, "a", "b", "c")
    assert len(ledger(database).claim(2)) == 2
    assert len(ledger(database).claim(2)) == 1


def test_who_dies_over_an_attempt_leaves_the_notice_due_after_the_lease(database, monkeypatch):
    ended(database, "a")
    ledger(database).claim(1)
    later(monkeypatch, TIME_LIMIT_S)
    assert ledger(database).claim(1) == ()
    later(monkeypatch, LEASE_MARGIN_S + 1.0)
    assert [due.attempt for due in ledger(database).claim(1)] == [2]


def test_a_settled_notice_is_not_due_again(database, monkeypatch):
    ended(database, "a")
    (due,) = ledger(database).claim(1)
    ledger(database).settle(
        due, state=WebhookState.DELIVERED, status=204, error=None, again_in_s=None
    )
    later(monkeypatch, 1e5)
    assert ledger(database).claim(1) == ()
    assert webhook(database, "a").state is WebhookState.DELIVERED


def test_an_attempt_taken_for_dead_changes_nothing_any_more(database, monkeypatch):
    ended(database, "a")
    (first,) = ledger(database).claim(1)
    later(monkeypatch, TIME_LIMIT_S + LEASE_MARGIN_S + 1.0)
    (second,) = ledger(database).claim(1)
    ledger(database).settle(
        first, state=WebhookState.GIVEN_UP, status=500, error="Late.", again_in_s=None
    )
    assert webhook(database, "a").state is WebhookState.DUE
    assert webhook(database, "a").attempts == second.attempt == 2


def test_what_is_handed_back_was_no_attempt(database):
    ended(database, "a")
    (due,) = ledger(database).claim(1)
    ledger(database).hand_back(due)
    assert webhook(database, "a").attempts == 0
    assert [again.attempt for again in ledger(database).claim(1)] == [1]
