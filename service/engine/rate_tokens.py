"""Token buckets in the database, one per API key, shared by all API processes.

The clock is the database's, since those of several machines differ. A bucket is full after a minute
whatever was in it, and a full one need not be stored: old rows are dropped and nothing is lost.
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
"""The limit is in requests per minute, and the capacity is one minute's worth."""

DROPPED_AFTER_S: Final = 3_600.0
"""Long after a bucket is full, so that a key in use is not dropped and re-added at every sweep."""

JUMP_S: Final = 10.0
"""A bucket filled more than this far in the future was filled before the clock was set back. If by
less, its statement waited for another one, and no time is counted twice."""

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
        """Give back ``returned`` tokens and take up to ``wanted``, in one statement."""
        try:
            with self._database.begin() as connection:
                statement = self._statement(connection, key, returned=returned, wanted=wanted)
                row = connection.execute(statement).one()
        except InternalError as error:
            # How Postgres refuses writes when it is read-only, as a standby is.
            raise EngineUnavailableError from error
        return Grant(tokens=row.granted, wait_s=max(0.0, (1.0 - row.tokens) / self._per_second))

    def _statement(
        self, connection: sa.Connection, key: str, *, returned: int, wanted: int
    ) -> sa.Executable:
        dialect = _Dialect(connection)
        # If another statement is changing the row, this one waits and then reads the row again, so
        # that what is written follows from the row's latest values.
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
    """Forget the buckets that have long been unused, including those of revoked keys."""
    now = _Dialect(connection).now
    connection.execute(
        sa.delete(RATE_TOKENS).where(RATE_TOKENS.c.filled_at < now - DROPPED_AFTER_S)
    )


class _Dialect:
    """Functions that SQLite and Postgres name differently."""

    def __init__(self, connection: sa.Connection) -> None:
        self._is_postgres = connection.dialect.name == "postgresql"

    @property
    def now(self) -> sa.ColumnElement[float]:
        """Seconds since the epoch, constant within a statement."""
        if self._is_postgres:
            return sa.cast(sa.extract("epoch", sa.func.statement_timestamp()), sa.Double)
        # Every version of SQLite has this one, with millisecond resolution.
        return (sa.func.julianday("now", type_=sa.Double) - JULIAN_EPOCH) * DAY_S

    def least(self, one: Any, other: Any) -> sa.ColumnElement[Any]:
        """The smaller of two."""
        return (sa.func.least if self._is_postgres else sa.func.min)(one, other)

    def greatest(self, one: Any, other: Any) -> sa.ColumnElement[Any]:
        """The larger of two."""
        return (sa.func.greatest if self._is_postgres else sa.func.max)(one, other)

    def whole(self, value: sa.ColumnElement[float]) -> sa.ColumnElement[Any]:
        """The floor of a value that is not negative."""
        # Not every SQLite has floor(), and Postgres' cast rounds.
        return sa.func.floor(value) if self._is_postgres else sa.cast(value, sa.Integer)
