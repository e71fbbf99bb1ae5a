"""Rows of wire types as CSV, for spreadsheets: RFC 4180, UTF-8, one header line."""

import csv
import io
from collections.abc import Iterable, Sequence

from pydantic import BaseModel


def models_csv(rows: Sequence[BaseModel], fields: Iterable[str]) -> bytes:
    """One line per row, one column per field; what is unknown stays empty."""
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, list(fields))
    table.writeheader()
    for each in rows:
        table.writerow({name: _cell(value) for name, value in each.model_dump().items()})
    return text.getvalue().encode()


def _cell(value: object) -> object:
    """As JSON has it, which spreadsheets read too; several values in one cell, by semicolons."""
    if isinstance(value, bool):
        return str(value).lower()
    return "; ".join(map(str, value)) if isinstance(value, tuple) else value
