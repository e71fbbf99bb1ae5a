"""Buckets of tokens in the database, one for each API key: what all API processes share.

The clock is the database's, since those of several machines differ. A bucket is full after a minute
whatever was in it, and a full one need not be kept: old rows are dropped and nothing is lost.
"""

from typing import Any, Final

import sqlalchemy as sa
from sqlalchemy.exc import InternalError

from service.engine.availability import available
from service.engine.port import EngineUnavailableError
from service.engine.tables import RATE_TOKENS
from service.engine.token_port import Grant
from service.engine.upsert import insert_or_update

FILLED_AFTER_S: Final = 60.0
"""The limit is one of requests a minute, and the capacity is that of a minute."""

DROPPED_AFTER_S: Final = 3_600.0
"""Long after a bucket was full, so that a key in use does not come and go with every sweep."""

JUMP_S: Final = 10.0
"""A bucket filled later than now by more than this was filled before the clock was set back. By
less: its statement waited for another, and a moment is not counted twice."""

JULIAN_EPOCH: Final = 2_440_587.5
DAY_S: Final = 86_400.0


class RateTokens:
    """Buckets of ``per_minute`` tokens; see :class:`service.engine.token_port.SharedTokens`."""

    def __init__(self, database: sa.Engine, *, per_minute: int) -> None:
        self._database = database
        self._capacity = per_minute
        self._per_second = per_minute / FILLED_AFTER_S

    @available
    def exchange(self, key: str, *, returned: int, wanted: int) -> Grant:
        """Give ``returned`` tokens back and take up to ``wanted``, by one statement."""
        try:
            with self._database.begin() as connection:
                statement = self._statement(connection, key, returned=returned, wanted=wanted)
                row = connection.execute(statement).one()
        except InternalError as error:
            # How Postgres refuses to write where it only reads, as a standby does.
            raise EngineUnavailableError from error
        return Grant(tokens=row.granted, wait_s=max(0.0, (1.0 - row.tokens) / self._per_second))

    def _statement(
        self, connection: sa.Connection, key: str, *, returned: int, wanted: int
    ) -> sa.Executable:
        dialect = _Dialect(connection)
        # A row that is being changed by another statement is waited for and then read anew, so that
        # what is written follows from what it holds then.
        filled_s = dialect.greatest(dialect.now - RATE_TOKENS.c.filled_at, 0.0)
        there = dialect.least(
            RATE_TOKENS.c.tokens + filled_s * self._per_second + float(returned),
            float(self._capacity),
        )
        granted = dialect.least(dialect.whole(there), wanted)
        at_first = min(self._capacity, wanted)
        insert = insert_or_update(connection, RATE_TOKENS).values(
            key_id=key,
            tokens=float(self._capacity - at_first),
            granted=at_first,
            filled_at=dialect.now,
        )
        return insert.on_conflict_do_update(
            index_elements=[RATE_TOKENS.c.key_id],
            set_={
                "tokens": there - granted,
                "granted": granted,
                "filled_at": sa.case(
                    (RATE_TOKENS.c.filled_at > dialect.now + JUMP_S, dialect.now),
                    else_=dialect.greatest(RATE_TOKENS.c.filled_at, dialect.now),
                ),
            },
        ).returning(RATE_TOKENS.c.tokens, RATE_TOKENS.c.granted)


def drop_full_buckets(connection: sa.Connection) -> None:
    """Forget the buckets that nobody has met for long, those of revoked keys among them."""
    now = _Dialect(connection).now
    connection.execute(
        sa.delete(RATE_TOKENS).where(RATE_TOKENS.c.filled_at < now - DROPPED_AFTER_S)
    )


class _Dialect:
    """What SQLite and Postgres call differently."""

    def __init__(self, connection: sa.Connection) -> None:
        self._is_postgres = connection.dialect.name == "postgresql"

    @property
    def now(self) -> sa.ColumnElement[float]:
        """Seconds since the epoch, the same all through a statement."""
        if self._is_postgres:
            return sa.cast(sa.extract("epoch", sa.func.statement_timestamp()), sa.Double)
        # Any SQLite knows this one, in thousandths of a second.
        return (sa.func.julianday("now", type_=sa.Double) - JULIAN_EPOCH) * DAY_S

    def least(self, one: Any, other: Any) -> sa.ColumnElement[Any]:
        """The smaller of two."""
        return (sa.func.least if self._is_postgres else sa.func.min)(one, other)

    def greatest(self, one: Any, other: Any) -> sa.ColumnElement[Any]:
        """The larger of two."""
        return (sa.func.greatest if self._is_postgres else sa.func.max)(one, other)

    def whole(self, value: sa.ColumnElement[float]) -> sa.ColumnElement[Any]:
        """The whole number below a value that is not negative."""
        # Not every SQLite has floor(), and Postgres' cast rounds.
        return sa.func.floor(value) if self._is_postgres else sa.cast(value, sa.Integer)
