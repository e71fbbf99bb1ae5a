"""Tokens as the database keeps them."""

import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
import sqlalchemy as sa

from service.engine.browser_token_port import NewBrowserToken
from service.engine.browser_tokens import (
    StoredBrowserTokens,
    drop_expired_tokens,
    has_jobs_left,
    take_job,
)
from service.engine.keys import KeyRing
from service.engine.tables import API_KEYS, BROWSER_TOKENS
from tests.integration.service.guarded_service import opened
from tests.integration.service.harness import Machine


@pytest.fixture
def database(machine: Machine) -> Iterator[sa.Engine]:
    with opened(machine) as database:
        yield database


def new_token(database: sa.Engine, **changes: Any) -> tuple[str, str]:
    """The text and the id of a token of a new key."""
    identity = KeyRing(database).create("shop").split("_")[1]
    asked = {"key_id": identity, "tenant": "shop", "lifetime_s": 60, "jobs": 5, "label": None}
    text, token = StoredBrowserTokens(database).create(NewBrowserToken(**asked | changes))
    return text, token.id


def test_of_many_at_once_no_more_get_a_job_than_there_are(database: sa.Engine):
    _, identity = new_token(database)
    got: list[bool] = []

    def take() -> None:
        with database.begin() as connection:
            got.append(take_job(connection, identity))

    threads = [threading.Thread(target=take) for _ in range(12)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert sorted(got) == [False] * 7 + [True] * 5
    with database.connect() as connection:
        assert not has_jobs_left(connection, identity)
        assert not has_jobs_left(connection, "nobody")


def test_only_a_hash_of_a_token_is_stored_and_it_goes_when_it_expires(database: sa.Engine):
    text, _ = new_token(database)
    gone, _ = new_token(database, lifetime_s=-1)
    tokens = StoredBrowserTokens(database)
    assert tokens.find(text) is not None
    assert tokens.find(gone) is None
    with database.begin() as connection:
        kept = [str(row) for row in connection.execute(sa.select(BROWSER_TOKENS))]
        assert len(kept) == 2
        assert not any(text.rpartition("_")[2] in row for row in kept)
        drop_expired_tokens(connection, time.time())
        assert len(connection.execute(sa.select(BROWSER_TOKENS)).all()) == 1
        connection.execute(sa.update(API_KEYS).values(revoked_at=time.time()))
    assert tokens.find(text) is None
