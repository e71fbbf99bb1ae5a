"""What a child can be asked for: a table of functions from bytes to bytes, by name.

A module with such a table, called ``TASKS``, is handed around by its dotted name: it is imported in
children only, as whoever owns them loads no numerics.
"""

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from api_schemas.problems import Problem
from service.jobs.records import Report
from service.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildSetup:
    """What holds for all tasks of a child.

    ``name`` is what the process is called where processes are listed, ``tasks`` the module of its
    table. ``models`` is the folder of the body models, None for those shipped with the package;
    ``detector`` that of the detector's weights, None for those of their package.
    """

    name: str
    tasks: str
    niceness: int = 0
    max_pixels: int
    models: Path | None
    detector: Path | None
    memory_mb: int
    log_level: str
    log_format: str


def child_setup(settings: Settings, *, name: str, tasks: str, niceness: int = 0) -> ChildSetup:
    """How children of that name work by these settings."""
    return ChildSetup(
        name=name,
        tasks=tasks,
        niceness=niceness,
        max_pixels=settings.max_pixels,
        models=settings.models_dir,
        detector=settings.detector_dir,
        memory_mb=settings.child_memory_mb,
        log_level=settings.log_level,
        log_format=settings.log_format,
    )


Parts = Mapping[str, bytes]
"""What a task is given, or gives: bytes by name."""

Observe = Callable[[Report], None]
"""What a task tells of its progress."""

Task = Callable[[ChildSetup, Parts, Observe], Parts]
"""Raises :class:`ProblemError` if it ends without a result for a reason that can be told."""


class ProblemError(Exception):
    """The task ends with this problem."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.code)
        self.problem = problem


def load_tasks(module: str) -> Mapping[str, Task]:
    """Import the table of the module of that dotted name."""
    return cast("Mapping[str, Task]", importlib.import_module(module).TASKS)
