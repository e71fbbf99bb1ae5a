"""The file of ``maquette validate``: a row for each fit of a person, with what tapes say.

Columns ``person``, ``gender``, ``height_cm`` and ``picture`` are needed. ``side_picture`` makes the
row a fit of two. ``points`` and ``side_points`` name JSON files with the points of a request;
without them all are proposed. ``focal_length_35mm`` and ``clothing`` are as in a request. Every
other column is a measurement by its name, in centimetres or kilograms; ``NAME_2`` is a second
reading.
"""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from api_schemas.measurement_names import unknown_name_remedy
from api_schemas.problems import Problem, problem
from fitter.vocabulary.choices import Clothing, Gender
from fitter.vocabulary.measurements import MEASUREMENT_UNITS
from service.submissions.refusal import RefusedError

NEEDED: Final = ("person", "gender", "height_cm", "picture")
OPTIONAL: Final = ("side_picture", "points", "side_points", "focal_length_35mm", "clothing")
AGAIN: Final = "_2"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tape:
    """A measurement by tape, centimetres or kilograms, and its second reading if there is one."""

    value: float
    again: float | None

    @property
    def mean(self) -> float:
        """Of the readings."""
        return self.value if self.again is None else 0.5 * (self.value + self.again)


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredPerson:
    """A row: one or two pictures of a person, and their measurements by name."""

    row: int
    person: str
    gender: Gender
    height_cm: float
    pictures: tuple[Path, ...]
    points: tuple[Path | None, ...]
    focal_length_35mm: float | None
    clothing: Clothing | None
    tapes: Mapping[str, Tape]


def read_people(file: Path) -> list[MeasuredPerson]:
    """Read the file; paths in it are relative to its folder.

    Raises
    ------
    RefusedError
        If a column or a value cannot be used: the first one is named with its row.
    OSError
        If the file cannot be read.
    """
    with file.open(newline="", encoding="utf-8-sig") as lines:
        reader = csv.DictReader(lines)
        columns = [name.strip() for name in reader.fieldnames or ()]
        reader.fieldnames = columns
        _check_columns(columns)
        # The first line is the heading.
        people = [
            _person(number, {name: (row[name] or "").strip() for name in columns}, file.parent)
            for number, row in enumerate(reader, start=2)
        ]
    if not people:
        raise RefusedError(
            _fault("The file has no row.", "Give one row for each fit of a person.", "people")
        )
    return people


def _check_columns(columns: list[str]) -> None:
    for name in NEEDED:
        if name not in columns:
            raise RefusedError(
                _fault(
                    f"There is no column '{name}'.", f"Give the columns {', '.join(NEEDED)}.", name
                )
            )
    for name in columns:
        measured = name.removesuffix(AGAIN)
        if name in (*NEEDED, *OPTIONAL) or measured in MEASUREMENT_UNITS:
            continue
        raise RefusedError(
            _fault(
                f"There is no column and no measurement '{name}'.",
                unknown_name_remedy(measured),
                name,
            )
        )


def _person(row: int, said: Mapping[str, str], folder: Path) -> MeasuredPerson:
    for name in NEEDED:
        if not said[name]:
            raise RefusedError(
                _fault(f"Row {row} has no {name}.", "Fill it in, or leave the row out.", name)
            )
    given = {name: said[name] for name in OPTIONAL if said.get(name)}
    pictures = [said["picture"], *([given["side_picture"]] if "side_picture" in given else [])]
    points = [given.get("points"), given.get("side_points")][: len(pictures)]
    tapes = {
        name: Tape(
            value=_number(row, name, said[name]),
            again=_number(row, name + AGAIN, said[name + AGAIN])
            if said.get(name + AGAIN)
            else None,
        )
        for name in MEASUREMENT_UNITS
        if said.get(name)
    }
    focal_length = given.get("focal_length_35mm")
    return MeasuredPerson(
        row=row,
        person=said["person"],
        gender=Gender(_one_of(row, "gender", said["gender"], tuple(Gender))),
        height_cm=_number(row, "height_cm", said["height_cm"]),
        pictures=tuple(_file(row, folder / each) for each in pictures),
        points=tuple(None if each is None else _file(row, folder / each) for each in points),
        focal_length_35mm=None
        if focal_length is None
        else _number(row, "focal_length_35mm", focal_length),
        clothing=Clothing(_one_of(row, "clothing", given["clothing"], tuple(Clothing)))
        if "clothing" in given
        else None,
        tapes=tapes,
    )


def _number(row: int, name: str, text: str) -> float:
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise RefusedError(
            _fault(
                f"Row {row}: {name} is '{text}'.", "Write a number above 0, without its unit.", name
            )
        )
    return value


def _one_of(row: int, name: str, text: str, known: tuple[str, ...]) -> str:
    if text not in known:
        raise RefusedError(
            _fault(f"Row {row}: {name} is '{text}'.", f"Use one of {', '.join(known)}.", name)
        )
    return text


def _file(row: int, path: Path) -> Path:
    if not path.is_file():
        raise RefusedError(
            _fault(
                f"Row {row}: there is no file {path}.",
                "Paths are relative to the table's folder.",
                "picture",
            )
        )
    return path


def _fault(detail: str, remedy: str, field: str) -> Problem:
    return problem("malformed-request", detail=detail, remedy=remedy, field=field)
