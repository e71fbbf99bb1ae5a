"""Measurement definitions: which landmarks, planes and parts, as data with their source.

``definitions.json`` beside this file holds them. Points are named by the body model's landmarks,
by ``joint:PART`` for the centre about which a part turns, or by ``skin:NAME`` for a place of
``skin_points.json``; several names mean their mean.
:mod:`fitter.measurement.definition_file` reads the file and checks it;
:mod:`fitter.measurement.anthropometry` measures by it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from fitter.body.model import BodyModel
from fitter.errors import DefinitionError
from fitter.measurement.skin_points import SKIN_PREFIX, load_skin_points

JOINT_PREFIX = "joint:"

PointNames = tuple[str, ...]

SOLES: PointNames = ("sole_left", "sole_right")


class Unit(StrEnum):
    """Units of values."""

    CENTIMETRES = "cm"
    KILOGRAMS = "kg"


class Selection(StrEnum):
    """Which of the cuts along the axis is taken."""

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


class Agreement(StrEnum):
    """Agreement of a measurement with the survey's."""

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
class IsoDefinition:
    """How ISO 8559-1:2017, the tailors' standard, takes the same of people; in our words.

    Attributes
    ----------
    term
        Its name there.
    clause
        Its number there; None where no public source tells it.
    agreement
        ``same`` or ``differs``.
    difference
        What is not the same.
    """

    term: str
    clause: str | None
    agreement: Agreement
    difference: str


@dataclass(frozen=True, slots=True, kw_only=True)
class About:
    """What is said of a measurement to its reader; ``iso`` is None where the standard lacks it."""

    name: str
    unit: Unit
    definition: str
    source: str
    survey: SurveyDefinition
    iso: IsoDefinition | None


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


def check_against_model(definitions: Sequence[MeasurementDefinition], model: BodyModel) -> None:
    """Make sure that every landmark, joint and part the definitions name is in the model.

    Raises
    ------
    DefinitionError
        Naming the measurement and what the model lacks.
    """
    known = set(model.landmarks.names) | {JOINT_PREFIX + part for part in model.part_names}
    for definition in definitions:
        for point in needed_points(definition):
            if point not in known:
                message = (
                    f"{definition.about.name}: the {model.gender} body model has no point {point}."
                )
                raise DefinitionError(message)
        for part in parts_of(definition):
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
    """The landmarks and joints a definition stands on: those its places of the skin are found by.

    Raises
    ------
    DefinitionError
        If it names a place of the skin that there is not.
    """
    needed: list[str] = []
    for name in points_of(definition):
        if not name.startswith(SKIN_PREFIX):
            needed.append(name)
            continue
        if name not in load_skin_points():
            message = f"{definition.about.name}: there is no place {name}."
            raise DefinitionError(message)
        needed.extend(load_skin_points()[name].needs)
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
