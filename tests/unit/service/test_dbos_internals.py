"""What is used of DBOS without being published: as it was when it was read, and in one module."""

import ast
import functools
import hashlib
import importlib
import importlib.metadata
import inspect
import re
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from sqlalchemy.exc import DBAPIError

from service.engine.dbos_internals import LONGEST_PAUSE_S, shorten_pauses

REPOSITORY = Path(__file__).parents[3]
ADAPTER = REPOSITORY / "service/engine/dbos_internals.py"
THESE_TESTS = {Path(__file__), REPOSITORY / "tests/integration/service/test_dbos_internals.py"}

LOOK_AT = (
    "This version of DBOS differs in what service/engine/dbos_internals.py uses without its being "
    "published. Read {what} in it, see whether {relied_on}, run "
    "tests/integration/service/test_dbos_internals.py, test_many_machines.py, test_failures.py and "
    "test_outages.py, and only then note here what is new."
)

SIGNATURES = [
    (
        "_dbos:DBOS._recover_pending_workflows",
        "executor_ids=['local']",
        "it still takes the names of the dead and puts back what stands as run by them",
    ),
    (
        "_sys_db:SystemDatabase.get_queue",
        "self, name, *, client_system_database=None",
        "it still returns a queue's record by name, or None",
    ),
    (
        "_sys_db:SystemDatabase.dequeue_scopes",
        "self, queue_name",
        "it still returns the list of what a queue is to be claimed from",
    ),
]

CLAIMS = "the limit of a worker is still `_worker_concurrency` less what it runs"
READS_FIRST = (
    "before each look the queue is read by `_sys_db.get_queue`, then `_sys_db.dequeue_scopes` is "
    "asked, `_polling_interval_sec` and after that `_worker_concurrency` are taken from what was "
    "read, and without scopes nothing is claimed"
)
PUTS_BACK = "only what stands as PENDING by one of the dead is put back, with its count"

REPEATS = "it still sleeps by the module's `time` between two attempts"

# Of each function that was read: the digest of its source, and what is relied on.
READ = [
    ("_queue:queue_worker_thread", "c0b22c3a946ff0c7", READS_FIRST),
    ("_sys_db:SystemDatabase.start_queued_workflows", "f8d6ba4ec0b52137", CLAIMS),
    ("_sys_db:SystemDatabase.get_queue", "89a5ccf936c5eee8", READS_FIRST),
    ("_sys_db:SystemDatabase.dequeue_scopes", "4e4f440a21b04a94", READS_FIRST),
    ("_sys_db:queue_from_db_row", "89454bc7ae33627a", READS_FIRST),
    ("_recovery:recover_pending_workflows", "9f2a97ad0756a741", PUTS_BACK),
    ("_recovery:_recover_workflow", "ebfc6ed4df454172", PUTS_BACK),
    ("_sys_db:SystemDatabase.reenqueue_for_recovery", "ac0bc1c45d8c36e4", PUTS_BACK),
    ("_sys_db:db_retry", "c548d54a31c8ccbd", REPEATS),
]


def part_of_dbos(path: str, *, relied_on: str) -> Any:
    """Something of DBOS by its module and name; a test that finds it gone says what to read."""
    module, _, name = path.partition(":")
    try:
        return functools.reduce(getattr, name.split("."), importlib.import_module(f"dbos.{module}"))
    except (ImportError, AttributeError):
        pytest.fail(f"There is no {path}. " + LOOK_AT.format(what=module, relied_on=relied_on))


def test_one_version_alone_is_installed_and_asked_for():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    (asked_for,) = (
        each for each in map(Requirement, project["dependencies"]) if each.name == "dbos"
    )
    installed = importlib.metadata.version("dbos")
    assert str(asked_for.specifier) == f"=={installed}", (
        "service/engine/dbos_internals.py uses what DBOS does not publish: pyproject.toml must ask "
        "for exactly the version it was tested with."
    )


@pytest.mark.parametrize(
    ("path", "expected", "relied_on"), SIGNATURES, ids=[path for path, _, _ in SIGNATURES]
)
def test_what_is_called_takes_what_it_took(path, expected, relied_on):
    function = part_of_dbos(path, relied_on=relied_on)
    parameters = inspect.signature(function).parameters.values()
    bare = [each.replace(annotation=inspect.Parameter.empty) for each in parameters]
    found = str(inspect.Signature(bare))[1:-1]
    assert found == expected, LOOK_AT.format(what=path, relied_on=relied_on)


@pytest.mark.parametrize(("path", "digest", "relied_on"), READ, ids=[path for path, _, _ in READ])
def test_what_is_relied_on_is_as_it_was_read(path, digest, relied_on):
    function = part_of_dbos(path, relied_on=relied_on)
    source = inspect.getsource(inspect.unwrap(function))
    found = hashlib.sha256(source.encode()).hexdigest()[:16]
    assert found == digest, LOOK_AT.format(what=path, relied_on=relied_on)


def test_what_is_replaced_is_where_it_was():
    dbos = part_of_dbos("_dbos:DBOS", relied_on=READS_FIRST)
    queue = part_of_dbos("_queue:Queue", relied_on=READS_FIRST)
    assert isinstance(inspect.getattr_static(dbos, "_sys_db", None), property), LOOK_AT.format(
        what="DBOS._sys_db", relied_on="it is the system database that the queue's thread asks"
    )
    assert {"_worker_concurrency", "_polling_interval_sec"} <= set(
        queue.__init__.__code__.co_names
    ), LOOK_AT.format(what="Queue", relied_on=READS_FIRST)


def test_what_fails_for_want_of_the_database_is_repeated_after_short_pauses(
    monkeypatch: pytest.MonkeyPatch,
):
    system_database = importlib.import_module("dbos._sys_db")
    # To be put back afterwards.
    monkeypatch.setattr(system_database, "time", time)
    slept: list[float] = []
    monkeypatch.setattr(time, "sleep", slept.append)
    shorten_pauses()

    lost = DBAPIError("UPDATE", {}, Exception(), connection_invalidated=True)

    @system_database.db_retry()
    def write() -> str:
        if len(slept) < 8:
            raise lost
        return "written"

    assert write() == "written"
    assert len(slept) == 8
    assert max(slept) == LONGEST_PAUSE_S


@pytest.mark.parametrize("path", ["_gone:DBOS", "_dbos:DBOS._gone"])
def test_what_is_gone_is_told_with_what_to_read(path):
    with pytest.raises(pytest.fail.Exception, match=r"There is no .* see whether all is well"):
        part_of_dbos(path, relied_on="all is well")


def test_nothing_else_uses_what_is_not_published():
    sources = [*(REPOSITORY / "service").rglob("*.py"), *(REPOSITORY / "tests").rglob("*.py")]
    found = [
        f"{path.relative_to(REPOSITORY)}:{fault}"
        for path in sources
        if path != ADAPTER and path not in THESE_TESTS
        for fault in private_uses(path.read_text())
    ]
    assert not found, (
        "Use what DBOS publishes, or a function of service/engine/dbos_internals.py: "
        + ", ".join(found)
    )


@pytest.mark.parametrize(
    "source",
    [
        "from dbos._sys_db import SystemDatabase",
        "from dbos import _queue",
        "import dbos._queue",
        "from dbos import DBOS\nDBOS._recover_pending_workflows([])",
        "def look(dbos):\n    return dbos._sys_db",
        "def stop(engine):\n    engine.background_thread_stop_events.clear()",
        "def limit(queue):\n    queue._worker_concurrency = 2",
        "setattr(queue, '_polling_interval_sec', 1.0)",
        "from sqlalchemy import table\ntable('workflow_status')",
        "READ = 'SELECT status FROM dbos.workflow_status'",
        "READ = 'SELECT * FROM dbos.queues'",
    ],
)
def test_a_private_use_is_found(source):
    assert list(private_uses(source))


@pytest.mark.parametrize(
    "source",
    [
        "from dbos import DBOS, DBOSClient\nDBOS.launch()",
        "class Engine:\n    def stop(self):\n        self._dbos.launch()",
        "import threading\nthreading.Thread(name='queues')",
    ],
)
def test_a_public_use_is_none(source):
    assert not list(private_uses(source))


NAMES = {
    "_sys_db",
    "_sys_db_field",
    "_recover_pending_workflows",
    "_worker_concurrency",
    "_polling_interval_sec",
    "background_thread_stop_events",
}


@functools.cache
def named_table() -> re.Pattern[str]:
    """Finds a table of DBOS in a string: by its schema, or by a name that only DBOS would give."""
    schema = part_of_dbos("_schemas.system_database:SystemSchema", relied_on="it has the tables")
    tables = [name.rpartition(".")[2] for name in schema.metadata_obj.tables]
    telling = [name for name in tables if "_" in name]
    return re.compile(rf"\bdbos\.({'|'.join(tables)})\b|\b({'|'.join(telling)})\b")


def private_uses(source: str) -> Iterator[str]:
    """Lines and names of what a module uses of DBOS that is not published."""
    tree = ast.parse(source)
    imports_dbos = False
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names) if any(each.name == "dbos" for each in names):
                imports_dbos = True
            case ast.Import(names=names) if any(each.name.startswith("dbos.") for each in names):
                yield f"{node.lineno} a module of dbos"
            case ast.ImportFrom(module="dbos", names=names):
                imports_dbos = True
                if any(each.name.startswith("_") for each in names):
                    yield f"{node.lineno} a module of dbos"
            case ast.ImportFrom(module=str(module)) if module.startswith("dbos."):
                yield f"{node.lineno} {module}"
            case ast.Attribute(attr=attribute) if attribute in NAMES:
                yield f"{node.lineno} {attribute}"
            case ast.Constant(value=str(text)) if text in NAMES or named_table().search(text):
                yield f"{node.lineno} {text[:40]}"
    if imports_dbos:
        for node in ast.walk(tree):
            match node:
                case ast.Attribute(value=ast.Name(id=owner), attr=attribute) if owner not in (
                    "self",
                    "cls",
                ) and re.match("_[^_]", attribute):
                    yield f"{node.lineno} {owner}.{attribute}"
