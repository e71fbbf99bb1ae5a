"""What commands have in common that work on pictures here and now: faults told, files written."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final, TypeVar

from rich.console import Console

from api_schemas.problems import field_problem
from api_schemas.results import Measurement
from fitter.errors import ModelFileError
from service.commands.terminal import print_problem
from service.representation.formats import GLB_ENDING
from service.representation.measurement_table import TABLE, measurements_csv
from service.submissions.refusal import RefusedError
from service.worker.pipeline_port import UnusableInputError

UNUSABLE_INPUT: Final = 2
"""Exit status if the input is at fault, as for wrong arguments."""

Made = TypeVar("Made")


def told(console: Console, work: Callable[[], Made]) -> Made | None:
    """Do the work; where the input is at fault, print that and return None."""
    try:
        return work()
    except ModelFileError as error:
        console.print(f"[bold red]The body model cannot be used.[/] {error}", highlight=False)
    except OSError as error:
        console.print(f"[bold red]{error.strerror}:[/] {error.filename}")
    except RefusedError as error:
        print_problem(console, error.problem)
    except UnusableInputError as error:
        print_problem(console, field_problem("unusable-input", error.error))
    return None


def write_files(
    folder: Path,
    documents: Mapping[str, bytes],
    measurements: Sequence[Measurement],
    *,
    formats: Sequence[str],
) -> int:
    """Write all files, meshes in these formats too, and the table; returns how many there are."""
    files = dict(documents) | _in_formats(documents, formats)
    files[TABLE] = measurements_csv(measurements)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)
    return len(files)


def _in_formats(files: Mapping[str, bytes], formats: Sequence[str]) -> dict[str, bytes]:
    """Every mesh in every one of the formats, by file name."""
    if not formats:
        return {}
    # Imported here: its libraries take a moment to load, and most fits do not need them.
    from fitter.export.formats import converted

    return {
        f"{name.removesuffix(GLB_ENDING)}.{ending}": converted(content, ending)
        for name, content in files.items()
        if name.endswith(GLB_ENDING)
        for ending in formats
    }
