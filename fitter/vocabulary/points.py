"""The points that are clicked, and which of them a fit can start from.

Names are COCO's seventeen and further ones. Left and right are the person's own. Places are
continuous pixels of the upright picture.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, Literal, get_args

FacePointName = Literal["nose", "left_eye", "right_eye", "left_ear", "right_ear"]
LimbPointName = Literal[
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
]
FurtherPointName = Literal[
    "neck", "head_top", "chin", "left_toe", "right_toe", "left_heel", "right_heel"
]
CocoPointName = Literal[FacePointName, LimbPointName]
PointName = Literal[CocoPointName, FurtherPointName]

FACE_POINT_NAMES: Final[tuple[FacePointName, ...]] = get_args(FacePointName)
LIMB_POINT_NAMES: Final[tuple[LimbPointName, ...]] = get_args(LimbPointName)
COCO_POINT_NAMES: Final[tuple[CocoPointName, ...]] = FACE_POINT_NAMES + LIMB_POINT_NAMES
POINT_NAMES: Final[tuple[PointName, ...]] = COCO_POINT_NAMES + get_args(FurtherPointName)

TRUNK_POINT_NAMES: Final[tuple[LimbPointName, ...]] = (
    "left_shoulder",
    "right_shoulder",
    "left_hip",
    "right_hip",
)

MIN_LIMB_POINTS: Final = 4
MIN_TRUNK_POINTS: Final = 2
"""Two trunk points and four limb points in all leave at least two whole limbs, as of shoulders and
elbows or of shoulders and hips: a root to hang the body on, and lengths to find its depth from. The
upper half of a person has them, a head does not."""

MIN_EXTENT: Final = 0.05
"""Points spread over less than this share of the picture's diagonal are no person to measure."""

CLEAR_BREADTH: Final = 0.2
"""A pair of joints tells left from right when its distance across the trunk exceeds this share of
the trunk's length: nearer to profile, a few pixels of clicking error decide the order."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PointFault:
    """Fault in points: the request's field, a stable code, the reason, and the remedy."""

    code: str
    field: str
    reason: str
    remedy: str


def place_faults(
    places: Mapping[str, tuple[float, float]], *, width: int, height: int
) -> Iterator[PointFault]:
    """Faults in single points of an upright picture of ``width`` x ``height`` pixels.

    ``point-unknown``, ``point-not-finite`` or ``point-outside-image``.
    """
    for name, (x, y) in places.items():
        if name not in POINT_NAMES:
            yield PointFault(
                code="point-unknown",
                field=f"points.{name}",
                reason="There is no point of this name.",
                remedy=f"Use one of {', '.join(POINT_NAMES)}.",
            )
        elif not (math.isfinite(x) and math.isfinite(y)):
            yield PointFault(
                code="point-not-finite",
                field=f"points.{name}",
                reason="A coordinate is not a finite number.",
                remedy="Leave out points that are not known.",
            )
        elif not (0.0 <= x <= width and 0.0 <= y <= height):
            yield PointFault(
                code="point-outside-image",
                field=f"points.{name}",
                reason=(
                    f"({x:g}, {y:g}) lies outside the upright picture of {width} x {height} pixels."
                ),
                remedy=(
                    "Give points in pixels of the picture as a browser shows it, at full size; "
                    "leave out those beyond its border."
                ),
            )


def shortage(
    places: Mapping[str, tuple[float, float]], *, width: int, height: int
) -> PointFault | None:
    """Why a fit cannot start from these points: ``too-few-points`` or ``points-too-close``."""
    limb_count = sum(name in places for name in LIMB_POINT_NAMES)
    trunk_count = sum(name in places for name in TRUNK_POINT_NAMES)
    if limb_count < MIN_LIMB_POINTS or trunk_count < MIN_TRUNK_POINTS:
        return PointFault(
            code="too-few-points",
            field="points",
            reason=f"There are {limb_count} limb points, {trunk_count} of them shoulders or hips.",
            remedy=(
                f"Click at least {MIN_LIMB_POINTS} of the shoulders, elbows, wrists, hips, knees "
                f"and ankles, {MIN_TRUNK_POINTS} of them shoulders or hips."
            ),
        )
    limbs = [places[name] for name in LIMB_POINT_NAMES if name in places]
    extent = math.hypot(
        max(x for x, _ in limbs) - min(x for x, _ in limbs),
        max(y for _, y in limbs) - min(y for _, y in limbs),
    )
    if extent < MIN_EXTENT * math.hypot(width, height):
        return PointFault(
            code="points-too-close",
            field="points",
            reason=f"All limb points lie within {extent:.0f} pixels.",
            remedy="Give the points in pixels of the whole picture, or crop it to the person.",
        )
    return None
