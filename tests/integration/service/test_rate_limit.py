"""The limit of requests over processes that share a database."""

import asyncio
import contextlib
import threading
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass, field

import pytest
import sqlalchemy as sa
from sqlalchemy import event

from service.api.rate_limit import RETRY_AWAY_S, RateLimit
from service.engine.database import open_database, prepare_database
from service.engine.facts import read_fact, write_fact
from service.engine.keys import KeyRing
from service.engine.port import EngineUnavailableError
from service.engine.rate_tokens import DROPPED_AFTER_S, RateTokens
from service.engine.tables import RATE_TOKENS
from tests.integration.service.harness import PATIENCE_S, Machine, running_service
from tests.integration.service.test_images import engine_of
from tests.integration.service.test_outages import locked, no_connections

KEY = "0123abcd"
LIMIT = 40
EVERYTHING = 1_000
"""More than there ever is."""


def url_of(machine: Machine) -> str:
    return machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"


@contextlib.contextmanager
def opened(machine: Machine) -> Iterator[sa.Engine]:
    """Open the database as one more process does; a lock on a file is not waited for."""
    database = open_database(url_of(machine))
    if machine.database_url is None:
        event.listen(database, "connect", lambda each, _: each.execute("PRAGMA busy_timeout=0"))
    try:
        yield database
    finally:
        database.dispose()


@pytest.fixture
def database(machine: Machine) -> Iterator[sa.Engine]:
    prepare_database(url_of(machine))
    engine = open_database(url_of(machine))
    yield engine
    engine.dispose()


@pytest.fixture
def other_database(machine: Machine, database: sa.Engine) -> Iterator[sa.Engine]:
    """The same, as another process has it open."""
    engine = open_database(url_of(machine))
    yield engine
    engine.dispose()


@dataclass
class Watch:
    """Tells how much comes in between its making and now, at the most."""

    began: float = field(default_factory=time.monotonic)

    def refill(self) -> float:
        return (time.monotonic() - self.began) * LIMIT / 60.0


def tokens_of(database: sa.Engine) -> RateTokens:
    return RateTokens(database, per_minute=LIMIT)


def taken(tokens: RateTokens, wanted: int = EVERYTHING, *, returned: int = 0) -> int:
    return tokens.exchange(KEY, returned=returned, wanted=wanted).tokens


def let_pass(database: sa.Engine, seconds: float) -> None:
    """Let time pass for every bucket; less than none sets the database's clock back."""
    with database.begin() as connection:
        filled_at = RATE_TOKENS.c.filled_at - seconds
        assert connection.execute(sa.update(RATE_TOKENS).values(filled_at=filled_at)).rowcount > 0


def kept_keys(database: sa.Engine) -> set[str]:
    with database.connect() as connection:
        return set(connection.execute(sa.select(RATE_TOKENS.c.key_id)).scalars())


def away(machine: Machine) -> AbstractContextManager[None]:
    return locked(machine) if machine.database_url is None else no_connections(machine)


def test_two_processes_together_let_as_many_pass_as_one(
    database: sa.Engine, other_database: sa.Engine
):
    watch = Watch()

    async def ask() -> int:
        first, second = (
            RateLimit(tokens_of(each), per_minute=LIMIT, patience_s=PATIENCE_S)
            for each in (database, other_database)
        )
        answers = [await limit.take(KEY) for _ in range(LIMIT) for limit in (first, second)]
        assert len(answers) == 2 * LIMIT
        assert all(told >= 1 for told in answers if told)
        return answers.count(0)

    assert LIMIT <= asyncio.run(ask()) <= LIMIT + watch.refill()


def test_those_who_take_at_once_never_get_more_than_there_is(
    database: sa.Engine, other_database: sa.Engine
):
    got: list[int] = []
    ready = threading.Barrier(8)

    def take_all(tokens: RateTokens) -> None:
        ready.wait()
        while more := taken(tokens, 3):
            got.append(more)

    watch = Watch()
    threads = [
        threading.Thread(target=take_all, args=(tokens_of(each),))
        for each in (database, other_database) * 4
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert LIMIT <= sum(got) <= LIMIT + watch.refill()


def test_a_bucket_fills_evenly_and_does_not_overflow(database: sa.Engine):
    tokens, watch = tokens_of(database), Watch()
    assert taken(tokens) == LIMIT
    refused = tokens.exchange(KEY, returned=0, wanted=1)
    if refused.tokens == 0:
        assert 0.0 < refused.wait_s <= 60.0 / LIMIT
    let_pass(database, 30.0)
    assert LIMIT // 2 <= refused.tokens + taken(tokens) <= LIMIT // 2 + watch.refill()
    let_pass(database, 600.0)
    assert taken(tokens) == LIMIT


def test_what_is_given_back_is_there_for_others(database: sa.Engine, other_database: sa.Engine):
    first, second, watch = tokens_of(database), tokens_of(other_database), Watch()
    assert taken(first, 30) == 30
    assert taken(first, 0, returned=20) == 0
    assert 30 <= taken(second) <= 30 + watch.refill()
    assert taken(first, returned=EVERYTHING) == LIMIT


def test_a_clock_set_back_stops_no_bucket_from_filling(database: sa.Engine):
    tokens = tokens_of(database)
    assert taken(tokens) == LIMIT
    let_pass(database, -3_600.0)
    assert taken(tokens) == 0
    let_pass(database, 30.0)
    assert taken(tokens) >= LIMIT // 2


def test_a_moment_is_not_counted_twice_by_a_statement_that_had_to_wait(database: sa.Engine):
    tokens = tokens_of(database)
    assert taken(tokens) == LIMIT
    # As if another had filled it meanwhile, until some seconds from now.
    let_pass(database, -9.0)
    assert taken(tokens) == 0
    let_pass(database, 9.0)
    watch = Watch()
    assert taken(tokens) <= 1 + watch.refill()


def test_without_the_database_each_process_limits_by_itself(machine: Machine, database: sa.Engine):
    with opened(machine) as own:
        limit = RateLimit(tokens_of(own), per_minute=LIMIT)
        watch = Watch()

        async def ask() -> int:
            return [await limit.take(KEY) for _ in range(2 * LIMIT)].count(0)

        async def ask_until_it_is_shared() -> None:
            deadline = time.monotonic() + PATIENCE_S
            while kept_keys(database) != {KEY}:
                assert time.monotonic() < deadline
                await limit.take(KEY)
                await asyncio.sleep(RETRY_AWAY_S / 10)

        with away(machine):
            with pytest.raises(EngineUnavailableError):
                taken(tokens_of(own))
            assert LIMIT <= asyncio.run(ask()) <= LIMIT + watch.refill()
        assert kept_keys(database) == set()
        asyncio.run(ask_until_it_is_shared())
        # What passed meanwhile was taken from it.
        assert taken(tokens_of(own)) <= watch.refill()


def test_an_outage_is_answered_as_without_a_limit(machine: Machine, database: sa.Engine):
    key = KeyRing(database).create("somebody")
    settings = {"authentication": "keys", "requests_per_minute": LIMIT}
    limited = Machine(machine.data_dir, machine.database_url, settings)
    with running_service(limited, api_only=True) as service:
        service.client.headers["Authorization"] = f"Bearer {key}"
        assert service.client.get("/v1/fits").status_code == 200
        with away(machine):
            statuses = {service.client.get("/v1/fits").status_code for _ in range(6)}
        # A locked file can still be read.
        assert statuses == ({200} if machine.database_url is None else {503})


def test_a_database_that_only_reads_counts_as_away(machine: Machine, database: sa.Engine):
    statement = {
        "sqlite": "PRAGMA query_only=ON",
        "postgresql": "SET SESSION CHARACTERISTICS AS TRANSACTION READ ONLY",
    }[database.dialect.name]

    def only_read(connection, _) -> None:
        connection.execute(statement)
        connection.commit()

    with opened(machine) as standby:
        event.listen(standby, "connect", only_read)
        with pytest.raises(EngineUnavailableError):
            taken(tokens_of(standby))


def test_the_buckets_of_keys_that_are_revoked_or_asleep_are_swept(machine: Machine):
    engine = engine_of(machine)
    try:
        with opened(machine) as database:
            ring, tokens = KeyRing(database), tokens_of(database)
            revoked, asleep, awake = (ring.create("somebody").split("_")[1] for _ in range(3))
            for key in (revoked, asleep):
                tokens.exchange(key, returned=0, wanted=LIMIT)
            assert ring.revoke(revoked)
            let_pass(database, DROPPED_AFTER_S + 1.0)
            tokens.exchange(awake, returned=0, wanted=LIMIT)
            engine._sweeper.sweep()
            assert kept_keys(database) == {awake}
            # It was full long before.
            assert tokens.exchange(asleep, returned=0, wanted=EVERYTHING).tokens == LIMIT
    finally:
        engine.close()


def test_a_database_made_before_there_were_buckets_gets_them(machine: Machine, database: sa.Engine):
    with database.begin() as connection:
        RATE_TOKENS.drop(connection)
        write_fact(connection, "something", "kept")
    prepare_database(url_of(machine))
    assert taken(tokens_of(database)) == LIMIT
    with database.connect() as connection:
        assert read_fact(connection, "something") == "kept"


def test_without_keys_there_is_no_limit_and_nothing_is_written(embedded: Machine):
    limited = Machine(embedded.data_dir, settings={"requests_per_minute": 10})
    with running_service(limited, api_only=True) as service:
        statuses = {service.client.get("/v1/fits").status_code for _ in range(30)}
    assert statuses == {200}
    with opened(limited) as database:
        assert kept_keys(database) == set()
