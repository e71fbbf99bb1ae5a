"""``maquette validate``: how far fits are off on people who were measured with a tape.

Measurements are columns of a table by their names; ``NAME_2`` is a second reading.
"""

import argparse
import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from api_schemas.fit import FitRequest
from api_schemas.person import unknown_name_remedy
from api_schemas.picture import ViewRequest
from api_schemas.problems import problem
from fitter.fits.equipment import Equipment
from fitter.population.body_estimate import estimate_body
from fitter.population.validation import ErrorFigures, Estimate, Pair, error_figures, mean_absolute
from fitter.request import KnownMeasurement
from fitter.vocabulary.choices import Clothing, Gender, ViewKind
from fitter.vocabulary.measurements import MEASUREMENT_UNITS, STATURE, WEIGHT
from service.commands.fit import INPUT_FAULTS, PIPELINE, add_output, fault_lines, fitted, told
from service.jobs.inputs import SentPicture
from service.startup import UNUSABLE, run_command
from service.submissions.refusal import RefusedError

REPORT: Final = "validation.md"
NULLS: Final = ((STATURE,), (STATURE, WEIGHT))
"""Measurements that are known where no picture is looked at."""

AGAIN: Final = "_2"

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class Row(BaseModel):
    """A fit of a person to one picture, or to one from the front and one from the side.

    All other columns are readings, in centimetres or kilograms.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Positive]  # pyright: ignore[reportIncompatibleVariableOverride]

    person: str
    gender: Gender
    height_cm: Positive
    picture: Path
    side_picture: Path | None = None
    focal_length_35mm: Positive | None = None
    clothing: Clothing | None = None

    @property
    def tapes(self) -> dict[str, Positive]:
        """Readings by their columns' names."""
        return self.__pydantic_extra__

    def tape(self, name: str) -> float:
        """The mean of the readings of a measurement."""
        first = self.tapes[name]
        return 0.5 * (first + self.tapes.get(name + AGAIN, first))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fit:
    """Measurements of a row's pictures with standard errors by name, or why there are none."""

    number: int
    row: Row
    found: Mapping[str, tuple[float, float | None]] = field(default_factory=dict)
    fault: str | None = None

    def pair(self, name: str) -> Pair:
        """A measurement that both the pictures and the tape have."""
        value, standard_error = self.found[name]
        return Pair(
            person=self.row.person,
            found=value,
            standard_error=standard_error,
            tape=self.row.tapes[name],
            again=self.row.tapes.get(name + AGAIN),
        )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """A table, and where the report goes."""
    parser.add_argument("people", type=Path, metavar="TABLE", help="service/docs/validate.md")
    add_output(parser, Path("maquette-validation"))


def run(parsed: argparse.Namespace) -> int:
    """Validate on the people of a table."""
    return run_command(
        "validate",
        lambda settings: validate(parsed.people, parsed.output, models=settings.models_dir),
    )


def validate(
    file: Path, output: Path, *, models: Path | None = None, pipeline: str = PIPELINE
) -> int:
    """Fit every row of a table, write and print the report; return the exit status."""
    if (rows := told(lambda: read_table(file))) is None:
        return UNUSABLE
    fits: list[_Fit] = []
    for number, row in rows.items():
        print(f"Row {number}: {row.person}")
        fits.append(_fit(number, row, file.parent, pipeline=pipeline))
    report = _report(fits, models)
    output.mkdir(parents=True, exist_ok=True)
    (output / REPORT).write_text(report)
    print(f"{report}\n{REPORT} lies in {output}.")
    return 0


def read_table(file: Path) -> dict[int, Row]:
    """Read the rows of a table, by their numbers: the heading is the first.

    The first column or value that cannot be used is refused, with its row.
    """
    with file.open(newline="", encoding="utf-8-sig") as lines:
        reader = csv.DictReader(lines)
        columns = [name.strip() for name in reader.fieldnames or ()]
        for name in columns:
            measured = name.removesuffix(AGAIN)
            if name not in Row.model_fields and measured not in MEASUREMENT_UNITS:
                detail = f"There is no column and no measurement '{name}'."
                raise _refused(detail, unknown_name_remedy(measured), name)
        reader.fieldnames = columns
        rows = {number: _row_of(number, each) for number, each in enumerate(reader, start=2)}
    if not rows:
        empty = "The file has no row."
        raise _refused(empty, "Give a row for each fit of a person.", "person")
    return rows


def _row_of(number: int, cells: Mapping[str, str]) -> Row:
    try:
        return Row.model_validate(
            {name: text.strip() for name, text in cells.items() if text and text.strip()}
        )
    except ValidationError as error:
        fault = error.errors()[0]
        name = str(fault["loc"][0])
        detail = f"Row {number}, {name}: {fault['msg']}."
        remedy = "Numbers have a point and no unit; the columns are in service/docs/validate.md."
        raise _refused(detail, remedy, name) from error


def _refused(detail: str, remedy: str, column: str) -> RefusedError:
    return RefusedError(problem("malformed-request", detail=detail, remedy=remedy, field=column))


def _fit(number: int, row: Row, folder: Path, *, pipeline: str) -> _Fit:
    views = {None: row.picture}
    if row.side_picture is not None:
        views = {ViewKind.FRONT: row.picture, ViewKind.SIDE: row.side_picture}
    shared = row.model_dump(include={"focal_length_35mm", "clothing"}, exclude_none=True)
    asked = FitRequest(
        gender=row.gender,
        height_m=round(row.height_cm / 100.0, 4),
        views=tuple(ViewRequest(view=kind, **shared) for kind in views),
    )
    try:
        pictures = [SentPicture((folder / path).read_bytes(), None) for path in views.values()]
        result, _ = fitted(asked, pictures, pipeline=pipeline)
    except INPUT_FAULTS as error:
        return _Fit(number=number, row=row, fault=" ".join(" ".join(fault_lines(error)).split()))
    found = {each.name: (each.value, each.standard_error) for each in result.measurements}
    fault = None if found else f"withheld: {result.outcome_explanation}"
    return _Fit(number=number, row=row, found=found, fault=fault)


def _null_errors(
    fits: Sequence[_Fit], known: tuple[str, ...], models: Path | None
) -> dict[str, list[list[float]]]:
    """Errors of the most probable body, without a picture, by measurement and person."""
    equipment = Equipment(models=models)
    errors: dict[str, list[list[float]]] = {}
    for row in {fit.row.person: fit.row for fit in fits if fit.found}.values():
        true = {name: row.tape(name) for name in row.tapes if name in MEASUREMENT_UNITS}
        true[STATURE] = row.height_cm
        if not set(known) <= true.keys():
            continue
        population = equipment.model(row.gender).population
        given = {name: KnownMeasurement(value=true[name]) for name in known}
        body = estimate_body(population, given).measurements
        for each in body:
            if each.name in true.keys() - set(known) - {STATURE}:
                errors.setdefault(each.name, []).append([each.value - true[each.name]])
    return errors


def _report(fits: Sequence[_Fit], models: Path | None) -> str:
    nulls = [_null_errors(fits, known, models) for known in NULLS]
    measured = sum(bool(fit.found) for fit in fits)
    people = len({fit.row.person for fit in fits})
    lines = [
        "# Validation",
        "",
        f"{measured} of {len(fits)} fits of {people} people gave measurements.",
        "In brackets: 95 % intervals, bootstrapped over people.",
        "",
        f"| {_HEADING} |",
        "|---" * (_HEADING.count("|") + 1) + "|",
    ]
    for name, unit in MEASUREMENT_UNITS.items():
        pairs = [fit.pair(name) for fit in fits if name in fit.found and name in fit.row.tapes]
        if pairs:
            beside = [errors.get(name) for errors in nulls]
            lines.append(_row(f"{name}, {unit}", error_figures(pairs), beside))
    lines += ["", "The columns are explained in service/docs/validate.md.", ""]
    faults = [f"- row {fit.number}, {fit.row.person}: {fit.fault}" for fit in fits if fit.fault]
    if faults:
        lines += ["Not measured:", "", *faults, ""]
    return "\n".join(lines)


_HEADING: Final = (
    "measurement | people | fits | mean absolute | bias | 95 % hold | half width | repeatability | "
    "tape | by height | by height and weight"
)


def _row(title: str, figures: ErrorFigures, nulls: Sequence[list[list[float]] | None]) -> str:
    cells = [
        title,
        str(figures.people),
        str(figures.pictures),
        _shown(figures.mean_absolute),
        _shown(figures.bias, "+.1f"),
        _shown(figures.held, ".0%"),
        _shown(figures.half_width),
        _shown(figures.repeatability),
        _shown(figures.tape_error),
        *(_shown(mean_absolute(each) if each else None) for each in nulls),
    ]
    return f"| {' | '.join(cells)} |"


def _shown(value: Estimate | float | None, form: str = ".1f") -> str:
    if value is None:
        return "-"
    if not isinstance(value, Estimate):
        return f"{value:{form}}"
    interval = "" if value.low is None else f" ({value.low:{form}} to {value.high:{form}})"
    return f"{value.value:{form}}{interval}"
