"""``maquette validate``: how far fits are off on people who were measured with a tape.

A table has a row for each fit of a person (:class:`Row`). Every column that is no field of a row is
a measurement by its name, in centimetres or kilograms; ``NAME_2`` is a second reading.
"""

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from api_schemas.fit import FitRequest
from api_schemas.person import unknown_name_remedy
from api_schemas.problems import field_problem, problem
from fitter.fits.equipment import Equipment
from fitter.population.body_estimate import estimate_body
from fitter.population.validation import ErrorFigures, Estimate, Pair, error_figures, mean_absolute
from fitter.request import KnownMeasurement
from fitter.vocabulary.choices import Clothing, Gender, ViewKind
from fitter.vocabulary.measurements import MEASUREMENT_UNITS, STATURE, WEIGHT
from service.commands.fit import PIPELINE, UNUSABLE_INPUT, fitted, told
from service.compute.pipeline_port import UnusableInputError
from service.jobs.inputs import SentPicture
from service.submissions.refusal import RefusedError

REPORT: Final = "validation.md"
NULLS: Final = ((STATURE,), (STATURE, WEIGHT))
"""What is known where no picture is looked at."""

AGAIN: Final = "_2"

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
TAPES: Final = TypeAdapter(dict[str, Positive])


class Row(BaseModel):
    """A fit of a person to one picture, or to one from the front and one from the side."""

    person: str
    gender: Gender
    height_cm: Positive
    picture: Path
    side_picture: Path | None = None
    focal_length_35mm: Positive | None = None
    clothing: Clothing | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fit:
    """What came of a row: measurements with standard errors by name, or why there are none.

    ``tapes`` are the readings of its columns.
    """

    number: int
    row: Row
    tapes: Mapping[str, float]
    found: Mapping[str, tuple[float, float | None]]
    fault: str | None

    def tape(self, name: str) -> float:
        """The mean of the readings of a measurement."""
        first = self.tapes[name]
        return 0.5 * (first + self.tapes.get(name + AGAIN, first))


def validate(
    file: Path, output: Path, *, models: Path | None = None, pipeline: str = PIPELINE
) -> int:
    """Fit every row of a table, write and print the report; return the exit status."""
    rows = told(lambda: read_table(file))
    if rows is None:
        return UNUSABLE_INPUT
    fits: list[_Fit] = []
    for number, (row, tapes) in rows.items():
        print(f"Row {number}: {row.person}")
        found, fault = _measured(row, file.parent, pipeline=pipeline)
        fits.append(_Fit(number=number, row=row, tapes=tapes, found=found, fault=fault))
    report = _report(fits, models)
    output.mkdir(parents=True, exist_ok=True)
    (output / REPORT).write_text(report)
    print(f"{report}\n{REPORT} lies in {output}.")
    return 0


def read_table(file: Path) -> dict[int, tuple[Row, dict[str, float]]]:
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
        raise _refused(empty, "Give one row for each fit of a person.", "person")
    return rows


def _row_of(number: int, cells: Mapping[str, str]) -> tuple[Row, dict[str, float]]:
    said = {name: text.strip() for name, text in cells.items() if text and text.strip()}
    tapes = {name: said.pop(name) for name in list(said) if name not in Row.model_fields}
    try:
        return Row.model_validate(said), TAPES.validate_python(tapes)
    except ValidationError as error:
        fault = error.errors()[0]
        name = str(fault["loc"][0])
        detail = f"Row {number}, {name}: {fault['msg']}."
        remedy = "Numbers have a point and no unit; the columns are in service/docs/validate.md."
        raise _refused(detail, remedy, name) from error


def _refused(detail: str, remedy: str, field: str) -> RefusedError:
    return RefusedError(problem("malformed-request", detail=detail, remedy=remedy, field=field))


def _measured(
    row: Row, folder: Path, *, pipeline: str
) -> tuple[dict[str, tuple[float, float | None]], str | None]:
    """The measurements of a row's pictures with their standard errors, or why there are none."""
    views = {None: row.picture}
    if row.side_picture is not None:
        views = {ViewKind.FRONT: row.picture, ViewKind.SIDE: row.side_picture}
    shared = row.model_dump(include={"focal_length_35mm", "clothing"}, exclude_none=True)
    asked = {
        "gender": row.gender,
        "height_m": round(row.height_cm / 100.0, 4),
        "views": [{"view": kind} | shared for kind in views],
    }
    try:
        pictures = [SentPicture((folder / path).read_bytes(), None) for path in views.values()]
        result = fitted(
            FitRequest.model_validate_json(json.dumps(asked)), pictures, pipeline=pipeline
        ).result
    except OSError as error:
        return {}, f"{error.strerror}: {error.filename}"
    except RefusedError as error:
        return {}, error.problem.detail
    except UnusableInputError as error:
        return {}, field_problem("unusable-input", error.error).detail
    found = {each.name: (each.value, each.standard_error) for each in result.measurements}
    return found, None if found else f"withheld: {result.outcome_explanation}"


def _pairs(fits: Sequence[_Fit]) -> dict[str, list[Pair]]:
    """What pictures and tapes say, by measurement."""
    pairs: dict[str, list[Pair]] = {}
    for fit in fits:
        for name in fit.found.keys() & fit.tapes.keys():
            value, standard_error = fit.found[name]
            pair = Pair(
                person=fit.row.person,
                found=value,
                standard_error=standard_error,
                tape=fit.tapes[name],
                again=fit.tapes.get(name + AGAIN),
            )
            pairs.setdefault(name, []).append(pair)
    return pairs


def _null_errors(
    fits: Sequence[_Fit], known: tuple[str, ...], models: Path | None
) -> dict[str, list[list[float]]]:
    """Errors of the most probable body, without a picture, by measurement and person."""
    equipment = Equipment(models=models)
    errors: dict[str, list[list[float]]] = {}
    for fit in {fit.row.person: fit for fit in fits if fit.found}.values():
        true = {name: fit.tape(name) for name in fit.tapes if name in MEASUREMENT_UNITS}
        true[STATURE] = fit.row.height_cm
        if not set(known) <= true.keys():
            continue
        population = equipment.model(fit.row.gender).population
        given = {name: KnownMeasurement(value=true[name]) for name in known}
        body = estimate_body(population, given).measurements
        for each in (each.measurement for each in body):
            if each.name in true.keys() - set(known) - {STATURE}:
                errors.setdefault(each.name, []).append([each.value - true[each.name]])
    return errors


def _report(fits: Sequence[_Fit], models: Path | None) -> str:
    pairs = _pairs(fits)
    nulls = [_null_errors(fits, known, models) for known in NULLS]
    measured = [fit for fit in fits if fit.found]
    people = len({fit.row.person for fit in fits})
    lines = [
        "# Validation",
        "",
        f"{len(measured)} of {len(fits)} fits of {people} people gave measurements.",
        "In brackets: 95 % intervals, bootstrapped over people.",
        "",
        f"| {_HEADING} |",
        "|---" * (_HEADING.count("|") + 1) + "|",
    ]
    for name, unit in MEASUREMENT_UNITS.items():
        if name in pairs:
            beside = [errors.get(name) for errors in nulls]
            lines.append(_row(f"{name}, {unit}", error_figures(pairs[name]), beside))
    lines += ["", *_EXPLAINED, ""]
    faults = [f"- row {fit.number}, {fit.row.person}: {fit.fault}" for fit in fits if fit.fault]
    if faults:
        lines += ["Not measured:", "", *faults, ""]
    return "\n".join(lines)


_HEADING: Final = (
    "measurement | people | fits | mean absolute | bias | 95 % hold | half width | repeatability | "
    "tape | by height | by height and weight"
)
_EXPLAINED: Final = (
    "- *half width*: the median of what the fits' own 95 % intervals allow.",
    "- *repeatability*: the standard deviation of what several fits of one person say.",
    "- *tape*: the technical error of measurement, from second readings.",
    "- *by height*, *by height and weight*: the mean absolute error of the most probable body",
    "  of these, without a picture. A picture that does not err less tells nothing.",
)


def _row(title: str, figures: ErrorFigures, nulls: Sequence[list[list[float]] | None]) -> str:
    cells = [
        title,
        str(figures.people),
        str(figures.pictures),
        _with_interval(figures.mean_absolute),
        _with_interval(figures.bias, sign="+"),
        "-" if figures.held is None else _with_interval(figures.held, percent=True),
        _or_dash(figures.half_width),
        _or_dash(figures.repeatability),
        _or_dash(figures.tape_error),
        *("-" if each is None else _with_interval(mean_absolute(each)) for each in nulls),
    ]
    return f"| {' | '.join(cells)} |"


def _with_interval(estimate: Estimate, *, sign: str = "", percent: bool = False) -> str:
    form, scale, unit = (".0f", 100.0, " %") if percent else (f"{sign}.1f", 1.0, "")
    value = f"{scale * estimate.value:{form}}{unit}"
    if estimate.low is None or estimate.high is None:
        return value
    return f"{value} ({scale * estimate.low:{form}} to {scale * estimate.high:{form}})"


def _or_dash(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"
