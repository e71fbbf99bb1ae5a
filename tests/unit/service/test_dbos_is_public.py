"""The service uses of DBOS only what DBOS publishes."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[3]
ITSELF = Path(__file__)

TABLES = re.compile(r"\bdbos\.\w+|\bworkflow_status\b|\boperation_outputs\b")
"""DBOS's own tables in a statement."""

STATEMENT = re.compile(r"\b(SELECT|INSERT|UPDATE|DELETE)\b|^\w+$")


def test_nothing_uses_what_is_not_published():
    sources = [*(REPOSITORY / "service").rglob("*.py"), *(REPOSITORY / "tests").rglob("*.py")]
    found = [
        f"{path.relative_to(REPOSITORY)}:{fault}"
        for path in sources
        if path != ITSELF and "dbos" in (text := path.read_text())
        for fault in private_uses(text)
    ]
    assert not found, f"Use what DBOS publishes: {', '.join(found)}"


@pytest.mark.parametrize(
    "source",
    [
        "from dbos._sys_db import SystemDatabase",
        "from dbos import _queue",
        "import dbos._queue",
        "from dbos import DBOS\nDBOS._recover_pending_workflows([])",
        "from dbos import DBOS\ndef look(engine):\n    return engine.dbos._sys_db",
        "from dbos import DBOS\nsetattr(DBOS, '_sys_db', None)",
        "READ = 'SELECT status FROM dbos.workflow_status'",
        "READ = 'SELECT * FROM dbos.queues'",
    ],
)
def test_a_private_use_is_found(source: str):
    assert list(private_uses(source))


@pytest.mark.parametrize(
    "source",
    [
        "from dbos import DBOS, DBOSClient, error\nDBOS.launch()",
        "from dbos import DBOS\nclass Engine:\n    def stop(self):\n        self._dbos.launch()",
        "import logging\nlogging.getLogger('dbos')",
    ],
)
def test_a_public_use_is_none(source: str):
    assert not list(private_uses(source))


def private_uses(source: str) -> Iterator[str]:
    """Lines and names of what a module uses of DBOS that is not published."""
    nodes = list(ast.walk(ast.parse(source)))
    imports_dbos = False
    for node in nodes:
        match node:
            case ast.Import(names=names) if any(each.name.startswith("dbos.") for each in names):
                yield f"{node.lineno} a module of dbos"
            case ast.ImportFrom(module=str(module)) if module.startswith("dbos."):
                yield f"{node.lineno} {module}"
            case ast.ImportFrom(module="dbos", names=names):
                imports_dbos = True
                if any(each.name.startswith("_") for each in names):
                    yield f"{node.lineno} a module of dbos"
            case ast.Constant(value=str(text)) if TABLES.search(text) and STATEMENT.search(text):
                yield f"{node.lineno} {text[:40]}"
    for node in nodes if imports_dbos else ():
        match node:
            case ast.Attribute(value=owner, attr=name) if re.match("_[^_]", name):
                if not (isinstance(owner, ast.Name) and owner.id in ("self", "cls")):
                    yield f"{node.lineno} {name}"
            case ast.Call(func=ast.Name(id="setattr"), args=[_, ast.Constant(value=str(name)), _]):
                if name.startswith("_"):
                    yield f"{node.lineno} {name}"
