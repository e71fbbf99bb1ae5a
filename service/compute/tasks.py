"""Tasks of child processes: functions from bytes to bytes, in tables by name.

A module with such a table, called ``TASKS``, is handed around by its dotted name: it is imported in
children only, as whoever owns them loads no numerics.
"""

import hashlib
import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Final, cast

from api_schemas.problems import FieldProblem, Problem, field_problem
from api_schemas.results import FitResult, ResultFile
from service.jobs.inputs import RESULT
from service.jobs.records import Report
from service.process.confinement import readable_paths
from service.settings import Settings

PRODUCT: Final = "product"
"""The task of every product of a fit; that of a fit is :data:`service.jobs.records.FIT`."""

OPTIONS: Final = "options"
"""The part that says what is asked for."""

Parts = Mapping[str, bytes]
"""Bytes by name: what a task is given, or gives."""

Observe = Callable[[Report], None]
"""Takes a task's reports of its progress."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildSetup:
    """Settings of all tasks of a child.

    ``name`` is what the process is called where processes are listed, ``tasks`` the module of its
    table. ``models`` is the folder of the body models, None for those shipped with the package;
    ``detector`` that of the detector's weights, None for those of their package. ``readable`` are
    the folders that it may read.
    """

    name: str
    tasks: str = ""
    niceness: int = 0
    max_pixels: int
    models: Path | None = None
    detector: Path | None = None
    memory_mb: int = 4_096
    log_level: str = "INFO"
    log_format: str = "text"
    readable: tuple[str, ...] = ()


def child_setup(settings: Settings, *, name: str, tasks: str, niceness: int = 0) -> ChildSetup:
    """The setup of children of that name by these settings."""
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
        readable=readable_paths(settings),
    )


Task = Callable[[ChildSetup, Parts, Observe], Parts]
"""Raises :class:`ProblemError` if it ends without a result for a reason that can be told."""


class ProblemError(Exception):
    """The task ends with this problem."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.code)
        self.problem = problem


class UnusableInputError(ProblemError):
    """The caller's input cannot be used."""

    def __init__(self, error: FieldProblem) -> None:
        super().__init__(field_problem("unusable-input", error))
        self.error = error


def load_tasks(module: str) -> Mapping[str, Task]:
    """Import the table of the module of that dotted name."""
    return cast("Mapping[str, Task]", importlib.import_module(module).TASKS)


MEDIA_TYPES: Final[Mapping[str, str]] = {
    ".glb": "model/gltf-binary",
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".json": "application/json",
    ".csv": "text/csv",
    ".html": "text/html",
    ".npz": "application/zip",
    ".bvh": "text/plain",
    ".webp": "image/webp",
}


def describe_file(name: str, content: bytes, *, digest: str | None = None) -> ResultFile:
    """Describe a file that a job made by name, kind, size and content; its digest may be known."""
    return ResultFile(
        name=name,
        media_type=MEDIA_TYPES[PurePath(name).suffix],
        size=len(content),
        sha256=digest or hashlib.sha256(content).hexdigest(),
    )


def with_result_document(result: FitResult, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Add ``result.json``, which lists all the other files."""
    listed = tuple(describe_file(name, content) for name, content in sorted(files.items()))
    document = result.model_copy(update={"files": listed}).model_dump_json(indent=1).encode()
    return {**files, RESULT: document}
