"""A database is a sandbox's, or it is not: canned results never get among real ones."""

from typing import Final

import sqlalchemy as sa

from service.engine.facts import read_fact, write_fact
from service.engine.port import DatabaseUnusableError
from service.engine.tables import JOBS

SANDBOX_FACT: Final = "sandbox"

_NAMES: Final = {True: "true", False: "false"}


def check_apart(connection: sa.Connection, *, sandbox: bool) -> None:
    """Check that the database is what it is taken for, so far as that is decided.

    Raises
    ------
    DatabaseUnusableError
        If it is the other.
    """
    found = read_fact(connection, SANDBOX_FACT)
    if found is None:
        # Jobs of a version that knew no sandboxes are real.
        has_jobs = connection.execute(sa.select(JOBS.c.id).limit(1)).first() is not None
        found = _NAMES[False] if has_jobs else _NAMES[sandbox]
    if found == _NAMES[sandbox]:
        return
    another = "choose another MAQUETTE_DATA_DIR or MAQUETTE_DATABASE_URL"
    message = (
        "MAQUETTE_SANDBOX=true: the database is no sandbox's, and canned results must not get "
        f"among its own; {another}, or unset MAQUETTE_SANDBOX for API and workers alike"
        if sandbox
        else "MAQUETTE_SANDBOX=false: the database is a sandbox's, whose results are canned; "
        f"{another}, or set MAQUETTE_SANDBOX=true for API and workers alike"
    )
    raise DatabaseUnusableError(message)


def keep_apart(connection: sa.Connection, *, sandbox: bool) -> None:
    """Note what the database is from now on; raises as :func:`check_apart` does."""
    check_apart(connection, sandbox=sandbox)
    write_fact(connection, SANDBOX_FACT, _NAMES[sandbox])
