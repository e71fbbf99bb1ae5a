"""Tables as lines of text."""

import textwrap
from collections.abc import Sequence

INDENT = "  "
NOTE_WIDTH = 92


def table_lines(
    title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]
) -> tuple[str, ...]:
    """A title, column heads and rows: the first column to the left, the others to the right.

    Parameters
    ----------
    columns
        Heads; the first may be empty.
    rows
        As many cells each as there are heads.
    """
    cells = [list(columns), *(list(row) for row in rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(columns))]
    lines = [
        row[0].ljust(widths[0])
        + "".join(f"  {cell.rjust(width)}" for cell, width in zip(row[1:], widths[1:], strict=True))
        for row in cells
    ]
    # Without heads there is no line for them.
    shown = lines if any(columns) else lines[1:]
    return (INDENT + title, *(2 * INDENT + line.rstrip() for line in shown))


def note_lines(text: str) -> tuple[str, ...]:
    """Sentences, wrapped and indented."""
    return tuple(2 * INDENT + line for line in textwrap.wrap(text, NOTE_WIDTH))
