"""Clicked points, under our names or as a detector prints them.

Coordinates are continuous pixels of the picture as a browser shows it (EXIF orientation applied):
the origin is the top-left corner, the centre of the top-left pixel is (0.5, 0.5). Left and right
are the person's own.
"""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Annotated, Final, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, WithJsonSchema

from api_schemas.base import WireModel, refusal
from fitter.vocabulary.points import COCO_POINT_NAMES, PointName

OPENPOSE_BODY25_INDEX: Final[Mapping[PointName, int]] = {
    **dict(
        zip(
            COCO_POINT_NAMES,
            (0, 16, 15, 18, 17, 5, 2, 6, 3, 7, 4, 12, 9, 13, 10, 14, 11),
            strict=True,
        )
    ),
    "left_toe": 19,
    "left_heel": 21,
    "right_toe": 22,
    "right_heel": 24,
}
"""Where BODY_25 keeps each of our points. Its neck is the middle of the shoulders, not the throat,
so it is left out."""

BLAZEPOSE33_INDEX: Final[Mapping[PointName, int]] = {
    **dict(
        zip(
            COCO_POINT_NAMES,
            (0, 2, 5, 7, 8, 11, 12, 13, 14, 15, 16, 23, 24, 25, 26, 27, 28),
            strict=True,
        )
    ),
    "left_heel": 29,
    "right_heel": 30,
    "left_toe": 31,
    "right_toe": 32,
}

DETECTOR_SURE: Final = 0.5
"""A detector's points of less confidence than this are guesses: passed on as hidden."""

MOST_SHARE: Final = 2.0
"""BlazePose guesses points beyond the picture, but not most of them as far as this."""


class PointsFormat(StrEnum):
    """How ``points`` is laid out."""

    NAMED = "named"
    COCO17 = "coco17"
    OPENPOSE_BODY25 = "openpose_body25"
    BLAZEPOSE33 = "blazepose33"


POINT_COUNTS: Final[Mapping[PointsFormat, int]] = {
    PointsFormat.COCO17: 17,
    PointsFormat.OPENPOSE_BODY25: 25,
    PointsFormat.BLAZEPOSE33: 33,
}


def _coco_visibility(value: object) -> int:
    # bool is an int in Python and 2.0 is an integer in JSON Schema: take JSON's side in both.
    if isinstance(value, int | float) and not isinstance(value, bool) and value in (0, 1, 2):
        return int(value)
    raise refusal(
        code="unknown-visibility",
        reason="Visibility is 0 (not in the picture), 1 (hidden, guessed) or 2 (seen).",
        remedy="Send 0, 1 or 2 as COCO defines them, or leave it out for 2.",
    )


Visibility = Annotated[
    int,
    BeforeValidator(_coco_visibility),
    WithJsonSchema({"type": "integer", "enum": [0, 1, 2], "title": "Visibility"}),
]


class PointSource(StrEnum):
    """Who says where a point is: a person, or a detector that ``/v1/points`` asked."""

    CLICK = "click"
    PROPOSAL = "proposal"


class Point(WireModel):
    """A clicked point, continuous pixels, with COCO's visibility: 0 absent, 1 hidden, 2 seen.

    A point of ``/v1/points`` can be sent as it came: as a ``proposal`` it binds a fit as loosely as
    proposals of its name and ``confidence`` err. Who moves or confirms a point sends it as a
    ``click``, whose confidence does not count.
    """

    x: float
    y: float
    visibility: Visibility = 2
    source: PointSource = PointSource.CLICK
    confidence: float | None = Field(default=None, ge=0.0, le=1.0)


Row = tuple[float, float, float]


def _point_kind(value: object) -> str:
    return "[object]" if isinstance(value, Point | Mapping) else "[numbers]"


def _marked(place: tuple[float, ...]) -> tuple[float, ...]:
    """A place whose third number, if there is one, is a visibility."""
    return place if len(place) == 2 else (*place[:2], _coco_visibility(place[2]))


def _points_kind(value: object) -> str:
    if not isinstance(value, list | tuple):
        return "[named]"
    first: object = value[0] if value else None  # pyright: ignore[reportUnknownVariableType]
    if isinstance(first, list | tuple):
        return "[rows]"
    return "[numbers]"


def _points_or_auto_kind(value: object) -> str:
    return "[auto]" if isinstance(value, str) else _points_kind(value)


Coordinates = Annotated[
    tuple[float, ...],
    Field(min_length=2, max_length=3),
    AfterValidator(_marked),
    WithJsonSchema({"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 3}),
]
NamedPoint = Annotated[
    Annotated[Point, Tag("[object]")] | Annotated[Coordinates, Tag("[numbers]")],
    Discriminator(_point_kind),
]
"""``{"x": .., "y": .., "visibility": ..}``, ``[x, y]`` or ``[x, y, visibility]``."""

_Named = Annotated[dict[PointName, NamedPoint], Tag("[named]")]
_Numbers = Annotated[list[float], Field(min_length=1), Tag("[numbers]")]
_Rows = Annotated[list[Row], Field(min_length=1), Tag("[rows]")]

Points = Annotated[_Named | _Numbers | _Rows, Discriminator(_points_kind)]
"""Named points, or a detector's: a flat list of numbers, or rows of three."""

Auto = Literal["auto"]
AUTO: Final[Auto] = "auto"


def _auto(value: object) -> object:
    if value == AUTO:
        return value
    raise refusal(
        code="unknown-value",
        reason="The only word that may stand for points is 'auto'.",
        remedy=(
            'Send "auto", or an object of points as {"left_shoulder": [x, y], ...}, or a list '
            "with its 'format'."
        ),
    )


PointsOrAuto = Annotated[
    _Named | _Numbers | _Rows | Annotated[Auto, BeforeValidator(_auto), Tag("[auto]")],
    Discriminator(_points_or_auto_kind),
]
"""Points, or the word that has the service propose all of them.

The word comes last: what openapi-python-client generates refuses whatever follows a constant.
"""


def named_points(
    points: Points, layout: PointsFormat, *, width: int, height: int
) -> dict[PointName, Point]:
    """Translate any accepted layout to named points in pixels; absent points are left out.

    Points of a detector are proposals with its confidence: COCO's with scores, OpenPose's and
    BlazePose's.

    Parameters
    ----------
    points, layout
        As the caller sent them; their agreement is checked here.
    width, height
        Size of the upright picture in pixels; BlazePose counts in shares of it.
    """
    if layout is PointsFormat.NAMED:
        return points_by_name(points)
    rows = _detector_rows(points, layout)
    if layout is PointsFormat.COCO17:
        placed = dict[PointName, Row](zip(COCO_POINT_NAMES, rows, strict=True))
        if _has_scores(rows):
            return _proposals(placed)
        return _present(
            {
                name: Point(x=x, y=y, visibility=_coco_visibility(visibility))
                for name, (x, y, visibility) in placed.items()
            }
        )
    if layout is PointsFormat.OPENPOSE_BODY25:
        return _proposals({name: rows[index] for name, index in OPENPOSE_BODY25_INDEX.items()})
    _check_shares(rows)
    # BlazePose always prints all its points, also those beyond the picture's edge.
    return _proposals(
        {
            name: (rows[index][0] * width, rows[index][1] * height, rows[index][2])
            for name, index in BLAZEPOSE33_INDEX.items()
            if 0.0 <= rows[index][0] <= 1.0 and 0.0 <= rows[index][1] <= 1.0
        },
        least=-1.0,
    )


def _proposals(rows: Mapping[PointName, Row], *, least: float = 0.0) -> dict[PointName, Point]:
    """Points with a detector's confidence; one of ``least`` says that it saw nothing."""
    return {
        name: Point(
            x=x,
            y=y,
            visibility=2 if confidence >= DETECTOR_SURE else 1,
            source=PointSource.PROPOSAL,
            confidence=min(max(confidence, 0.0), 1.0),
        )
        for name, (x, y, confidence) in rows.items()
        if confidence > least
    }


def _has_scores(rows: Sequence[Row]) -> bool:
    """Whether a detector's scores stand where COCO has visibility."""
    marks = [mark for _, _, mark in rows]
    return all(0.0 <= mark <= 1.0 for mark in marks) and any(0.0 < mark < 1.0 for mark in marks)


def _check_shares(rows: Sequence[Row]) -> None:
    beyond = sum(max(x, y) > MOST_SHARE for x, y, _ in rows)
    if 2 * beyond > len(rows):
        raise refusal(
            code="points-in-pixels",
            reason="BlazePose's points are shares of the picture, but these look like pixels.",
            field="points",
            remedy="Divide each x by the picture's width and each y by its height: 0 to 1.",
        )


def _present(points: Mapping[PointName, Point]) -> dict[PointName, Point]:
    return {name: point for name, point in points.items() if point.visibility > 0}


def points_by_name(points: Points) -> dict[PointName, Point]:
    """Return named points in their full form; absent ones are left out."""
    if not isinstance(points, dict):
        raise refusal(
            code="points-not-named",
            reason="The points are a list, but the format is 'named'.",
            field="points",
            remedy="Send an object of points by name, or say in 'format' whose list it is.",
        )
    return _present({name: _as_point(point) for name, point in points.items()})


def _as_point(point: Point | tuple[float, ...]) -> Point:
    if isinstance(point, Point):
        return point
    x, y, *visibility = point
    return Point(x=x, y=y, visibility=int(visibility[0]) if visibility else 2)


def _detector_rows(points: Points, layout: PointsFormat) -> list[Row]:
    count = POINT_COUNTS[layout]
    rows: list[Row] = []
    numbers: list[float] = []
    # A dict has no rows: it falls through to the count below.
    for entry in points if isinstance(points, list) else []:
        if isinstance(entry, tuple):
            rows.append(entry)
        else:
            numbers.append(entry)
    if len(numbers) == 3 * count:
        rows = [(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]) for i in range(count)]
    if len(rows) != count:
        raise refusal(
            code="wrong-point-count",
            reason=f"The format '{layout}' has {count} points of three numbers each.",
            field="points",
            remedy=f"Send {count} rows [x, y, v], or {3 * count} numbers in one list.",
        )
    return rows
