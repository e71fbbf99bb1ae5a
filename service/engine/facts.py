"""Facts about the whole service, one text per name: the tables' version, the body models."""

import sqlalchemy as sa

from service.engine.tables import FACTS
from service.engine.upsert import insert_or_update


def read_fact(connection: sa.Connection, name: str) -> str | None:
    """Return the value stored under a name, None if there is none."""
    query = sa.select(FACTS.c.value).where(FACTS.c.name == name)
    return connection.execute(query).scalar_one_or_none()


def write_fact(connection: sa.Connection, name: str, value: str) -> None:
    """Store a value, replacing any earlier one; of several concurrent writers the last one wins."""
    insert = insert_or_update(connection, FACTS).values(name=name, value=value)
    connection.execute(
        insert.on_conflict_do_update(
            index_elements=[FACTS.c.name], set_={"value": insert.excluded.value}
        )
    )


def touch_fact(connection: sa.Connection, name: str) -> None:
    """Write a fact again unchanged: raises if the database takes no writes."""
    connection.execute(sa.update(FACTS).where(FACTS.c.name == name).values(name=FACTS.c.name))
