"""Clicked points, under our names or as the rows of COCO's 17 keypoints.

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

DETECTOR_SURE: Final = 0.5
"""A detector's points of less confidence than this are guesses: passed on as hidden."""


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
    """Source of a point's position: a person, or a detector that ``/v1/points`` asked."""

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


def _has_scores(rows: Sequence[Row]) -> bool:
    """Whether a detector's scores stand where COCO has visibility."""
    marks = [mark for _, _, mark in rows]
    return all(0.0 <= mark <= 1.0 for mark in marks) and any(0.0 < mark < 1.0 for mark in marks)


def _marked_rows(rows: list[Row]) -> list[Row]:
    return rows if _has_scores(rows) else [(x, y, _coco_visibility(mark)) for x, y, mark in rows]


def _points_kind(value: object) -> str:
    return "[rows]" if isinstance(value, list | tuple) else "[named]"


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
_Rows = Annotated[
    list[Row],
    Field(min_length=len(COCO_POINT_NAMES), max_length=len(COCO_POINT_NAMES)),
    AfterValidator(_marked_rows),
    Tag("[rows]"),
]

Points = Annotated[_Named | _Rows, Discriminator(_points_kind)]
"""Named points; or COCO's 17 in its order, as ``[x, y, visibility]`` or ``[x, y, score]``."""

Auto = Literal["auto"]
AUTO: Final[Auto] = "auto"


def _auto(value: object) -> object:
    if value == AUTO:
        return value
    raise refusal(
        code="unknown-value",
        reason="The only word that may stand for points is 'auto'.",
        remedy=(
            'Send "auto", or an object of points as {"left_shoulder": [x, y], ...}, or the 17 '
            "rows [x, y, v] of COCO."
        ),
    )


PointsOrAuto = Annotated[
    _Named | _Rows | Annotated[Auto, BeforeValidator(_auto), Tag("[auto]")],
    Discriminator(_points_or_auto_kind),
]
"""Points, or the word that has the service propose all of them.

The word comes last: what openapi-python-client generates refuses whatever follows a constant.
"""


def named_points(points: Points) -> dict[PointName, Point]:
    """Points by their names, in full; absent ones are left out.

    Rows with scores are a detector's proposals, and a score of 0 says that it saw nothing.
    """
    named: dict[PointName, Point]
    if isinstance(points, dict):
        named = {name: _as_point(point) for name, point in points.items()}
    elif _has_scores(points):
        named = {
            name: Point(
                x=x,
                y=y,
                visibility=2 if score >= DETECTOR_SURE else 1,
                source=PointSource.PROPOSAL,
                confidence=score,
            )
            for name, (x, y, score) in zip(COCO_POINT_NAMES, points, strict=True)
            if score > 0.0
        }
    else:
        named = {
            name: Point(x=x, y=y, visibility=int(visibility))
            for name, (x, y, visibility) in zip(COCO_POINT_NAMES, points, strict=True)
        }
    return {name: point for name, point in named.items() if point.visibility > 0}


def _as_point(point: Point | tuple[float, ...]) -> Point:
    if isinstance(point, Point):
        return point
    x, y, *visibility = point
    return Point(x=x, y=y, visibility=int(visibility[0]) if visibility else 2)
