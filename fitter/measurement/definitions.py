"""Measurement definitions: which landmarks, planes and parts, as data with their source.

``definitions.json`` beside this file holds them. Points are named by the body model's landmarks,
by ``joint:PART`` for the centre about which a part turns, or by ``skin:NAME`` for a place of
``skin_points.json``; several names mean their mean. The file is ours: tests check it.
:mod:`fitter.measurement.anthropometry` measures by it.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, Final

from fitter.measurement.skin_points import SKIN_PREFIX, load_skin_points, triple

JOINT_PREFIX = "joint:"
DEFINITIONS_PATH = Path(__file__).with_name("definitions.json")

PointNames = tuple[str, ...]

SOLES: PointNames = ("sole_left", "sole_right")


class Unit(StrEnum):
    """Units of values."""

    CENTIMETRES = "cm"
    KILOGRAMS = "kg"


class Selection(StrEnum):
    """The cut along the axis that is taken."""

    LARGEST = "largest"
    SMALLEST = "smallest"


class Orientation(StrEnum):
    """Orientation of the cutting plane: level with the floor, or square to the axis."""

    LEVEL = "level"
    ACROSS_AXIS = "across_axis"


class Direction(StrEnum):
    """Direction of a caliper."""

    SIDEWAYS = "sideways"
    FORWARD = "forward"


@dataclass(frozen=True, slots=True, kw_only=True)
class SurveyFields:
    """The same in ANSUR II, the US Army's anthropometric survey of 2012.

    Attributes
    ----------
    fields
        The survey's fields whose sum it is; none where the survey does not take it.
    share
        Of that sum, what ours is taken to be: less than one where the survey tenses muscles.
    """

    fields: tuple[str, ...]
    share: float


@dataclass(frozen=True, slots=True, kw_only=True)
class About:
    """Description of a measurement to its reader.

    The file says more to the readers of MEASUREMENTS.md: how standard and survey take the same.
    """

    name: str
    unit: Unit
    definition: str
    source: str
    survey: SurveyFields


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
    """Height of a point above another one, standing pose; above the soles if no other is named."""

    about: About
    point: PointNames
    above: PointNames = SOLES


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """Breadth or depth of the tape of a level girth, by caliper, canonical pose."""

    about: About
    girth: Girth
    direction: Direction


@dataclass(frozen=True, slots=True, kw_only=True)
class Contour:
    """A tape laid taut over the skin along a path of points, canonical pose.

    Each step of the path has a side, a direction in the body frame (x to the person's left, y up,
    z forward): the tape lies in the plane that holds both ends and this direction, on that side of
    the convex hull of ``parts`` between them. A step without a side is straight.
    """

    about: About
    path: tuple[PointNames, ...]
    sides: tuple[tuple[float, float, float] | None, ...]
    parts: tuple[str, ...]


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


MeasurementDefinition = Girth | Extent | Length | Height | Contour | BackContour | Mass


def load_definitions() -> tuple[MeasurementDefinition, ...]:
    """All measurements, in the order of the file."""
    definitions: list[MeasurementDefinition] = []
    for entry in json.loads(DEFINITIONS_PATH.read_text(encoding="utf-8"))["measurements"]:
        definitions.append(_definition(entry, definitions))
    return tuple(definitions)


def _definition(
    entry: Mapping[str, Any], before: Sequence[MeasurementDefinition]
) -> MeasurementDefinition:
    """One of the file; an extent is that of a girth among those before it."""
    about = _about(entry)
    match entry["kind"]:
        case "girth":
            low, high = entry["fractions"]
            return Girth(
                about=about,
                start=tuple(entry["start"]),
                end=tuple(entry["end"]),
                origin=tuple(entry["origin"]) if "origin" in entry else None,
                fractions=(float(low), float(high)),
                selection=Selection(entry["selection"]),
                orientation=Orientation(entry["orientation"]),
                parts=tuple(entry["parts"]),
                around_axis=entry["around_axis"],
            )
        case "extent":
            girths = {each.about.name: each for each in before if isinstance(each, Girth)}
            return Extent(
                about=about, girth=girths[entry["of"]], direction=Direction(entry["direction"])
            )
        case "length":
            return Length(about=about, path=_path(entry))
        case "height":
            above = tuple(entry.get("above", SOLES))
            return Height(about=about, point=tuple(entry["point"]), above=above)
        case "contour":
            sides = tuple(side and triple(side) for side in entry["sides"])
            parts = tuple(entry["parts"])
            return Contour(about=about, path=_path(entry), sides=sides, parts=parts)
        case "back_contour":
            return BackContour(
                about=about,
                top=tuple(entry["top"]),
                bottom=tuple(entry["bottom"]),
                parts=tuple(entry["parts"]),
            )
        case "mass":
            return Mass(about=about, density_kg_per_m3=entry["density_kg_per_m3"])
        case kind:
            message = f"{about.name}: no measurement is of the kind {kind}."
            raise ValueError(message)


def _about(entry: Mapping[str, Any]) -> About:
    survey = entry["survey"]
    return About(
        name=entry["name"],
        unit=Unit(entry["unit"]),
        definition=entry["definition"],
        source=entry["source"],
        survey=SurveyFields(fields=tuple(survey["fields"]), share=survey.get("share", 1.0)),
    )


def _path(entry: Mapping[str, Any]) -> tuple[PointNames, ...]:
    return tuple(tuple(step) for step in entry["path"])


def points_of(definition: MeasurementDefinition) -> tuple[str, ...]:
    """Every point name a definition refers to."""
    match definition:
        case Girth():
            return definition.start + definition.end + (definition.origin or ())
        case Extent():
            return points_of(definition.girth)
        case Length() | Contour():
            return tuple(name for names in definition.path for name in names)
        case Height():
            return definition.point + definition.above
        case BackContour():
            return definition.top + definition.bottom
        case Mass():
            return ()


def needed_points(definition: MeasurementDefinition) -> tuple[str, ...]:
    """Landmarks and joints a definition stands on, directly or by its places of the skin."""
    needed: list[str] = []
    for name in points_of(definition):
        is_on_skin = name.startswith(SKIN_PREFIX)
        needed.extend(load_skin_points()[name].needs if is_on_skin else (name,))
    return tuple(needed)


def parts_of(definition: MeasurementDefinition) -> tuple[str, ...]:
    """The body parts a definition's tape may run over; none where it has no tape on the skin."""
    match definition:
        case Girth() | Contour() | BackContour():
            return definition.parts
        case Extent():
            return definition.girth.parts
        case Length() | Height() | Mass():
            return ()


INTERVAL_SD: Final = 1.959964
"""Half of a 95 % interval, in standard errors."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measurement:
    """One anthropometric measurement in its unit.

    Attributes
    ----------
    name
        A stable snake_case name, e.g. ``waist_girth_navel``.
    value, unit
        The value in ``unit``: ``cm`` or ``kg``.
    standard_error
        The Laplace approximation's standard deviation at the final body, in ``unit``; None where
        it was not computed.
    definition, source
        How it is taken, and by whom it is so defined.
    """

    name: str
    value: float
    unit: str
    standard_error: float | None
    definition: str
    source: str
