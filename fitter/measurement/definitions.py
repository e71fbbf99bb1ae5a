"""Measurement definitions: which landmarks, planes and parts, as data with their source.

``definitions.json`` beside this file holds them. Points are named by the body model's landmarks,
or ``joint:PART`` for the centre about which a part turns; several names mean their mean. This
module reads and checks the file; :mod:`fitter.measurement.anthropometry` measures by it.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import NoReturn, TypeVar, cast

from fitter.body.model import BodyModel
from fitter.errors import DefinitionError

FORMAT_VERSION = 1
DEFINITIONS_PATH = Path(__file__).with_name("definitions.json")
JOINT_PREFIX = "joint:"

PointNames = tuple[str, ...]

T = TypeVar("T")
C = TypeVar("C", bound=StrEnum)


class Unit(StrEnum):
    """What values are given in."""

    CENTIMETRES = "cm"
    KILOGRAMS = "kg"


class Selection(StrEnum):
    """Which of the cuts along the axis is taken."""

    LARGEST = "largest"
    SMALLEST = "smallest"


class Orientation(StrEnum):
    """How the cutting plane lies: level with the floor, or square to the axis."""

    LEVEL = "level"
    ACROSS_AXIS = "across_axis"


class Agreement(StrEnum):
    """How a measurement stands to the survey's."""

    SAME = "same"
    DIFFERS = "differs"
    ABSENT = "absent"


@dataclass(frozen=True, slots=True, kw_only=True)
class SurveyDefinition:
    """How ANSUR II (the US Army's anthropometric survey of 2012) takes the same of people.

    After its measurer's handbook (Hotzman et al. 2011, NATICK/TR-11/017) and report (Gordon et al.
    2014, NATICK/TR-15/007), in our words.

    Attributes
    ----------
    fields
        The survey's fields whose sum it is; none where the survey does not take it.
    share
        Of that sum, what ours is taken to be: less than one where the survey tenses muscles.
    agreement
        ``same``: the same landmarks and the same tape.
    definition
        Landmark, plane, tape and posture of the survey.
    difference
        What is not the same: landmark, plane, tape, posture, breath.
    """

    fields: tuple[str, ...]
    share: float
    agreement: Agreement
    definition: str
    difference: str


@dataclass(frozen=True, slots=True, kw_only=True)
class About:
    """What is said of a measurement to its reader."""

    name: str
    unit: Unit
    definition: str
    source: str
    survey: SurveyDefinition


@dataclass(frozen=True, slots=True, kw_only=True)
class Girth:
    """Length of the convex hull of a plane cut, canonical pose.

    The plane stands on the axis from ``start`` to ``end`` at a fraction within ``fractions``
    of its length. Zero is ``start``, or the point of the axis beside ``origin`` where one is
    given; the range may reach beyond both ends. ``parts`` are the body parts the cut may run over;
    with ``around_axis`` only the line that surrounds the axis counts. A part ends where vertices
    follow it by half.
    """

    about: About
    start: PointNames
    end: PointNames
    origin: PointNames | None
    fractions: tuple[float, float]
    selection: Selection
    orientation: Orientation
    parts: tuple[str, ...]
    around_axis: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Length:
    """Sum of the straight distances along a path of points, canonical pose."""

    about: About
    path: tuple[PointNames, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Height:
    """Height of a point above the soles, standing pose."""

    about: About
    point: PointNames


@dataclass(frozen=True, slots=True, kw_only=True)
class BackContour:
    """A tape laid taut down the back, in the vertical plane through ``top``, canonical pose.

    From ``top`` to the height of ``bottom``.
    """

    about: About
    top: PointNames
    bottom: PointNames
    parts: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Mass:
    """Volume times a constant density."""

    about: About
    density_kg_per_m3: float


MeasurementDefinition = Girth | Length | Height | BackContour | Mass


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
    root = _Entry("the file", document)
    if root.value("format_version", int) != FORMAT_VERSION:
        message = f"{path.name}: format_version is not {FORMAT_VERSION}, the one this code reads."
        raise DefinitionError(message)
    definitions = tuple(_read(entry) for entry in root.value("measurements", list))
    names = [definition.about.name for definition in definitions]
    for name in names:
        if names.count(name) > 1:
            message = f"{path.name}: {name} is defined {names.count(name)} times."
            raise DefinitionError(message)
    return definitions


def check_against_model(definitions: Sequence[MeasurementDefinition], model: BodyModel) -> None:
    """Make sure that every landmark, joint and part the definitions name is in the model.

    Raises
    ------
    DefinitionError
        Naming the measurement and what the model lacks.
    """
    known = set(model.landmarks.names) | {JOINT_PREFIX + part for part in model.part_names}
    for definition in definitions:
        for point in points_of(definition):
            if point not in known:
                message = (
                    f"{definition.about.name}: the {model.gender} body model has no point {point}."
                )
                raise DefinitionError(message)
        parts = definition.parts if isinstance(definition, Girth | BackContour) else ()
        for part in parts:
            if part not in model.part_names:
                message = (
                    f"{definition.about.name}: the {model.gender} body model has no part {part}."
                )
                raise DefinitionError(message)


def points_of(definition: MeasurementDefinition) -> tuple[str, ...]:
    """Every point name a definition refers to."""
    match definition:
        case Girth():
            return definition.start + definition.end + (definition.origin or ())
        case Length():
            return tuple(name for names in definition.path for name in names)
        case Height():
            return (*definition.point, "sole_left", "sole_right")
        case BackContour():
            return definition.top + definition.bottom
        case Mass():
            return ()


class _Entry:
    """One JSON object, read field by field with errors that name it."""

    def __init__(self, name: str, fields: object) -> None:
        if not isinstance(fields, dict):
            message = f"{name}: expected an object, found {type(fields).__name__}."
            raise DefinitionError(message)
        self.name = name
        self.fields = cast("Mapping[str, object]", fields)

    def value(self, field: str, kind: type[T]) -> T:
        if field not in self.fields:
            self.fail(field, "is missing")
        found = self.fields[field]
        if kind is float and isinstance(found, int) and not isinstance(found, bool):
            found = float(found)
        if not isinstance(found, kind) or (isinstance(found, bool) and kind is not bool):
            self.fail(field, f"is {found!r}, not of type {kind.__name__}")
        return cast("T", found)

    def names(self, field: str, *, may_be_empty: bool = False) -> tuple[str, ...]:
        values = self.value(field, list)
        if not (values or may_be_empty) or not all(isinstance(value, str) for value in values):
            self.fail(field, f"is {values!r}, not a list of names")
        return tuple(cast("list[str]", values))

    def choice(self, field: str, kind: type[C]) -> C:
        text = self.value(field, str)
        if text not in list(kind):
            self.fail(field, f"is {text!r}, not one of {', '.join(kind)}")
        return kind(text)

    def fail(self, field: str, fault: str) -> NoReturn:
        message = f"{self.name}: {field} {fault}."
        raise DefinitionError(message)


def _read(fields: object) -> MeasurementDefinition:
    entry = _Entry("a measurement", fields)
    entry = _Entry(entry.value("name", str), fields)
    about = About(
        name=entry.name,
        unit=entry.choice("unit", Unit),
        definition=entry.value("definition", str),
        source=entry.value("source", str),
        survey=_read_survey(_Entry(f"{entry.name}: survey", entry.value("survey", dict))),
    )
    match entry.value("kind", str):
        case "girth":
            return _read_girth(entry, about)
        case "length":
            path = entry.value("path", list)
            steps = tuple(_Entry(about.name, {"path": step}).names("path") for step in path)
            if len(steps) < 2:
                entry.fail("path", "has fewer than two points")
            return Length(about=about, path=steps)
        case "height":
            return Height(about=about, point=entry.names("point"))
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


def _read_survey(entry: _Entry) -> SurveyDefinition:
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


def _read_girth(entry: _Entry, about: About) -> Girth:
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
