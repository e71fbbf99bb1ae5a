"""``maquette validate``: how far fits are off on people who were measured with a tape."""

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from rich.console import Console

from api_schemas.fit import FitRequest
from api_schemas.problems import field_problem, problem
from fitter.fits.equipment import Equipment
from fitter.population.body_estimate import estimate_body
from fitter.population.validation import ErrorFigures, Estimate, Pair, error_figures, mean_absolute
from fitter.request import KnownMeasurement
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.measurements import MEASUREMENT_UNITS, STATURE, WEIGHT
from service.commands.fit import PIPELINE, UNUSABLE_INPUT, fitted, told
from service.commands.people_file import MeasuredPerson, read_people
from service.jobs.inputs import SentPicture
from service.submissions.refusal import RefusedError
from service.submissions.validation import parsed
from service.worker.pipeline_port import UnusableInputError

REPORT, PAIRS = "validation.md", "validation.csv"
NULLS: Final[Mapping[str, tuple[str, ...]]] = {
    "height": (STATURE,),
    "height and weight": (STATURE, WEIGHT),
}
"""What is known where no picture is looked at."""


VIEWS: Final = (ViewKind.FRONT, ViewKind.SIDE)
"""What the pictures of a row show, where it has two."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fit:
    """What came of a row: measurements with standard errors by name, or why there are none."""

    person: MeasuredPerson
    found: Mapping[str, tuple[float, float | None]]
    fault: str | None


def validate(
    file: Path, output: Path, *, models: Path | None = None, pipeline: str = PIPELINE
) -> int:
    """Fit every row of a table, write and print the report; return the exit status."""
    console = Console()
    people = told(console, lambda: read_people(file))
    if people is None:
        return UNUSABLE_INPUT
    fits: list[_Fit] = []
    for number, person in enumerate(people, start=1):
        console.print(f"Fit {number} of {len(people)}: {person.person}", highlight=False)
        fits.append(_fit(console, person, pipeline=pipeline))
    report = _report(fits, models)
    output.mkdir(parents=True, exist_ok=True)
    (output / REPORT).write_text(report)
    _write_pairs(fits, output / PAIRS)
    console.print(report, markup=False, highlight=False, soft_wrap=True)
    console.print(f"{REPORT} and {PAIRS} lie in {output}.", highlight=False)
    return 0


def _fit(console: Console, person: MeasuredPerson, *, pipeline: str) -> _Fit:
    pictures = [SentPicture(path.read_bytes(), None) for path in person.pictures]
    try:
        output = fitted(console, _asked(person), pictures, pipeline=pipeline)
    except RefusedError as error:
        return _Fit(person=person, found={}, fault=error.problem.detail)
    except UnusableInputError as error:
        problem = field_problem("unusable-input", error.error)
        return _Fit(person=person, found={}, fault=problem.detail)
    measured = output.result.measurements
    return _Fit(
        person=person,
        found={each.name: (each.value, each.standard_error) for each in measured},
        fault=None if measured else f"withheld: {output.result.outcome_explanation}",
    )


def _asked(person: MeasuredPerson) -> FitRequest:
    kinds = VIEWS if len(person.pictures) > 1 else (None,)
    request = {
        "gender": person.gender,
        "height_m": round(person.height_cm / 100.0, 4),
        "views": [
            {"view": kind} | _said_of(person, points)
            for kind, points in zip(kinds, person.points, strict=True)
        ],
    }
    return parsed(
        FitRequest, json.dumps(request).encode(), whole="request", called=f"row {person.row}"
    )


def _said_of(person: MeasuredPerson, points: Path | None) -> dict[str, object]:
    said: dict[str, object] = {}
    if points is not None:
        said |= {"points": _points(points)}
    if person.clothing is not None:
        said |= {"clothing": person.clothing}
    if person.focal_length_35mm is not None:
        said |= {"focal_length_35mm": person.focal_length_35mm}
    return said


def _points(file: Path) -> object:
    try:
        return json.loads(file.read_text())
    except json.JSONDecodeError as error:
        raise RefusedError(
            problem(
                "malformed-request",
                detail=f"{file} is not JSON: {error}.",
                remedy='Give an object of points, as {"left_shoulder": [x, y], ...}.',
                field="points",
            )
        ) from error


def _pairs(fits: Sequence[_Fit]) -> dict[str, list[Pair]]:
    """What pictures and tapes say, by measurement."""
    pairs: dict[str, list[Pair]] = {}
    for fit in fits:
        for name, tape in fit.person.tapes.items():
            if name in fit.found:
                value, standard_error = fit.found[name]
                pair = Pair(
                    person=fit.person.person,
                    found=value,
                    standard_error=standard_error,
                    tape=tape.value,
                    again=tape.again,
                )
                pairs.setdefault(name, []).append(pair)
    return pairs


def _null_errors(
    fits: Sequence[_Fit], known: tuple[str, ...], models: Path | None
) -> dict[str, list[list[float]]]:
    """Errors of the most probable body, without a picture, by measurement and person."""
    equipment = Equipment(models=models)
    errors: dict[str, list[list[float]]] = {}
    for person in {fit.person.person: fit.person for fit in fits if fit.found}.values():
        told_of = {name: tape.mean for name, tape in person.tapes.items()}
        told_of[STATURE] = person.height_cm
        if not set(known) <= told_of.keys():
            continue
        population = equipment.model(person.gender).population
        given = {name: KnownMeasurement(value=told_of[name]) for name in known}
        body = {
            each.measurement.name: each for each in estimate_body(population, given).measurements
        }
        for name in person.tapes.keys() - set(known):
            errors.setdefault(name, []).append([body[name].measurement.value - told_of[name]])
    return errors


def _report(fits: Sequence[_Fit], models: Path | None) -> str:
    pairs = _pairs(fits)
    nulls = {title: _null_errors(fits, known, models) for title, known in NULLS.items()}
    measured = [fit for fit in fits if fit.found]
    people = len({fit.person.person for fit in fits})
    lines = [
        "# Validation",
        "",
        f"{len(measured)} of {len(fits)} fits of {people} people gave measurements.",
        "In brackets: 95 % intervals, bootstrapped over people.",
        "",
        f"| {' | '.join((*_COLUMNS, *(f'by {title}' for title in nulls)))} |",
        "|---" * (len(_COLUMNS) + len(nulls)) + "|",
    ]
    for name, unit in MEASUREMENT_UNITS.items():
        if name in pairs:
            beside = [errors.get(name) for errors in nulls.values()]
            lines.append(_row(f"{name}, {unit}", error_figures(pairs[name]), beside))
    lines += ["", *_EXPLAINED, ""]
    faults = [
        f"- row {fit.person.row}, {fit.person.person}: {fit.fault}" for fit in fits if fit.fault
    ]
    if faults:
        lines += ["Not measured:", "", *faults, ""]
    return "\n".join(lines)


_COLUMNS: Final = (
    "measurement",
    "people",
    "fits",
    "mean absolute",
    "bias",
    "95 % hold",
    "half width",
    "repeatability",
    "tape",
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


def _write_pairs(fits: Sequence[_Fit], file: Path) -> None:
    """Every measurement that picture and tape both tell."""
    with file.open("w", newline="") as lines:
        table = csv.writer(lines)
        table.writerow(
            ("row", "person", "measurement", "unit", "found", "standard_error", "tape", "tape_2")
        )
        for fit in fits:
            for name, tape in fit.person.tapes.items():
                if name in fit.found:
                    value, error = fit.found[name]
                    about = (fit.person.row, fit.person.person, name, MEASUREMENT_UNITS[name])
                    rounded = None if error is None else round(error, 2)
                    table.writerow((*about, round(value, 2), rounded, tape.value, tape.again))
