"""Read ``definitions.json``, with errors that name the measurement and the field."""

import json
from collections.abc import Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import NoReturn, TypeVar, cast

from fitter.errors import DefinitionError
from fitter.measurement.definitions import (
    SOLES,
    About,
    Agreement,
    BackContour,
    Contour,
    Direction,
    Extent,
    Girth,
    Height,
    IsoDefinition,
    Length,
    Mass,
    MeasurementDefinition,
    Orientation,
    Selection,
    SurveyDefinition,
    Unit,
)

T = TypeVar("T")
C = TypeVar("C", bound=StrEnum)


class DefinitionEntry:
    """A JSON object, by what errors call it."""

    def __init__(self, name: str, fields: object) -> None:
        if not isinstance(fields, dict):
            message = f"{name}: expected an object, found {type(fields).__name__}."
            raise DefinitionError(message)
        self.name = name
        self.fields = cast("Mapping[str, object]", fields)

    def value(self, field: str, kind: type[T]) -> T:
        """The field's value, of a type; whole numbers will do for others."""
        if field not in self.fields:
            self.fail(field, "is missing")
        found = self.fields[field]
        if kind is float and isinstance(found, int) and not isinstance(found, bool):
            found = float(found)
        if not isinstance(found, kind) or (isinstance(found, bool) and kind is not bool):
            self.fail(field, f"is {found!r}, not of type {kind.__name__}")
        return cast("T", found)

    def names(self, field: str, *, may_be_empty: bool = False) -> tuple[str, ...]:
        """A list of names."""
        values = self.value(field, list)
        if not (values or may_be_empty) or not all(isinstance(value, str) for value in values):
            self.fail(field, f"is {values!r}, not a list of names")
        return tuple(cast("list[str]", values))

    def choice(self, field: str, kind: type[C]) -> C:
        """One of a few words."""
        text = self.value(field, str)
        if text not in list(kind):
            self.fail(field, f"is {text!r}, not one of {', '.join(kind)}")
        return kind(text)

    def path(self, field: str) -> tuple[tuple[str, ...], ...]:
        """Lists of names, at least two."""
        steps = tuple(
            DefinitionEntry(self.name, {field: step}).names(field)
            for step in self.value(field, list)
        )
        if len(steps) < 2:
            self.fail(field, "has fewer than two points")
        return steps

    def directions(self, field: str) -> tuple[tuple[float, float, float] | None, ...]:
        """Triples of numbers; None where there is null."""
        found: list[tuple[float, float, float] | None] = []
        for value in self.value(field, list):
            if value is None:
                found.append(None)
                continue
            if not isinstance(value, list) or len(value) != 3:
                self.fail(field, f"has {value!r}, not three numbers or null")
            x, y, z = (
                DefinitionEntry(self.name, {field: each}).value(field, float) for each in value
            )
            found.append((x, y, z))
        return tuple(found)

    def within(self, field: str) -> "DefinitionEntry":
        """The object in a field."""
        return DefinitionEntry(f"{self.name}: {field}", self.value(field, dict))

    def fail(self, field: str, fault: str) -> NoReturn:
        """Raise the error that this field is at fault."""
        message = f"{self.name}: {field} {fault}."
        raise DefinitionError(message)


FORMAT_VERSION = 1
DEFINITIONS_PATH = Path(__file__).with_name("definitions.json")


def load_definitions(path: Path = DEFINITIONS_PATH) -> tuple[MeasurementDefinition, ...]:
    """Read and check a definitions file.

    Raises
    ------
    DefinitionError
        If the file cannot be read or an entry is incomplete or contradictory; the message names
        the measurement and the field.
    """
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        message = f"{path.name} cannot be read as JSON ({error})."
        raise DefinitionError(message) from error
    root = DefinitionEntry("the file", document)
    if root.value("format_version", int) != FORMAT_VERSION:
        message = f"{path.name}: format_version is not {FORMAT_VERSION}, the one this code reads."
        raise DefinitionError(message)
    definitions: list[MeasurementDefinition] = []
    for fields in root.value("measurements", list):
        definitions.append(_read(fields, definitions))
    names = [definition.about.name for definition in definitions]
    for name in names:
        if names.count(name) > 1:
            message = f"{path.name}: {name} is defined {names.count(name)} times."
            raise DefinitionError(message)
    return tuple(definitions)


def _read(fields: object, before: Sequence[MeasurementDefinition]) -> MeasurementDefinition:
    """One definition; an extent is that of a girth among those ``before`` it."""
    entry = DefinitionEntry("a measurement", fields)
    entry = DefinitionEntry(entry.value("name", str), fields)
    about = _read_about(entry)
    match entry.value("kind", str):
        case "girth":
            return _read_girth(entry, about)
        case "extent":
            return _read_extent(entry, about, before)
        case "length":
            return Length(about=about, path=entry.path("path"))
        case "height":
            above = entry.names("above") if "above" in entry.fields else SOLES
            return Height(about=about, point=entry.names("point"), above=above)
        case "contour":
            path, sides = entry.path("path"), entry.directions("sides")
            if len(sides) != len(path) - 1:
                entry.fail("sides", f"has {len(sides)} entries for {len(path) - 1} steps")
            return Contour(about=about, path=path, sides=sides, parts=entry.names("parts"))
        case "back_contour":
            return BackContour(
                about=about,
                top=entry.names("top"),
                bottom=entry.names("bottom"),
                parts=entry.names("parts"),
            )
        case "mass":
            return Mass(about=about, density_kg_per_m3=entry.value("density_kg_per_m3", float))
        case kind:
            message = f"{about.name}: kind {kind!r} is not known."
            raise DefinitionError(message)


def _read_about(entry: DefinitionEntry) -> About:
    iso = entry.within("iso") if "iso" in entry.fields else None
    return About(
        name=entry.name,
        unit=entry.choice("unit", Unit),
        definition=entry.value("definition", str),
        source=entry.value("source", str),
        survey=_read_survey(entry.within("survey")),
        iso=None if iso is None else _read_iso(iso),
    )


def _read_iso(entry: DefinitionEntry) -> IsoDefinition:
    return IsoDefinition(
        term=entry.value("term", str),
        clause=entry.value("clause", str) if "clause" in entry.fields else None,
        agreement=entry.choice("agreement", Agreement),
        difference=entry.value("difference", str),
    )


def _read_survey(entry: DefinitionEntry) -> SurveyDefinition:
    survey = SurveyDefinition(
        fields=entry.names("fields", may_be_empty=True),
        share=entry.value("share", float) if "share" in entry.fields else 1.0,
        agreement=entry.choice("agreement", Agreement),
        definition=entry.value("definition", str),
        difference=entry.value("difference", str),
    )
    if bool(survey.fields) == (survey.agreement is Agreement.ABSENT):
        entry.fail("fields", f"is {list(survey.fields)} where the agreement is {survey.agreement}")
    return survey


def _read_girth(entry: DefinitionEntry, about: About) -> Girth:
    values = entry.value("fractions", list)
    if len(values) != 2 or not all(isinstance(value, int | float) for value in values):
        entry.fail("fractions", f"is {values!r}, not two numbers")
    low, high = float(values[0]), float(values[1])
    if low > high:
        entry.fail("fractions", f"runs from {low} down to {high}")
    return Girth(
        about=about,
        start=entry.names("start"),
        end=entry.names("end"),
        origin=entry.names("origin") if "origin" in entry.fields else None,
        fractions=(low, high),
        selection=entry.choice("selection", Selection),
        orientation=entry.choice("orientation", Orientation),
        parts=entry.names("parts"),
        around_axis=entry.value("around_axis", bool),
    )


def _read_extent(
    entry: DefinitionEntry, about: About, before: Sequence[MeasurementDefinition]
) -> Extent:
    name = entry.value("of", str)
    girths = [each for each in before if isinstance(each, Girth) and each.about.name == name]
    if not girths or girths[0].orientation is not Orientation.LEVEL:
        entry.fail("of", f"is {name!r}, no level girth that is defined before")
    return Extent(about=about, girth=girths[0], direction=entry.choice("direction", Direction))
