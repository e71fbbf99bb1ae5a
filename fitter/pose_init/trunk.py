"""Places of the trunk: every reading of its slant, with the root's depth.

Three things are ambiguous: whether the torso leans toward the camera or away, and which hip and
which shoulder is nearer. Whether the view is from the front or the back is not: it follows from
the order of left and right. A reference limb two steps from the trunk adds the facing of the limb
in between.

A body partly outside the picture, or a shoulder hidden behind the head, must not end the fit:
a missing corner is placed as the other cross-piece suggests. Guessed corners only start the pose;
the refinement never sees them.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.body.scape import CAMERA_AXES
from fitter.errors import InvalidInputError
from fitter.numerics.rotations import frames
from fitter.pose_init.click_problem import ClickedPoints
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.lifting import FAR, NEAR, Lifting
from fitter.pose_init.limbs import (
    HIPS,
    MIDDLES,
    PELVIS_MIDDLE,
    SHOULDERS,
    THORAX_MIDDLE,
    TORSO,
    Limb,
    limb_named,
    point_at_rest,
)

Pixels = Mapping[str, Float[np.ndarray, "2"]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrunkFacings:
    """The g combinations of what the trunk's image leaves ambiguous, each NEAR or FAR.

    Attributes
    ----------
    torso, hips, shoulders
        (g,) where the torso's upper end, the left hip and the left shoulder lie.
    between
        (g,) the facing of the limb between the reference limb and the trunk, where there is one.
    """

    torso: Integer[np.ndarray, " g"]
    hips: Integer[np.ndarray, " g"]
    shoulders: Integer[np.ndarray, " g"]
    between: Integer[np.ndarray, " g"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrunkReadings:
    """All readings of the trunk, g of them.

    Attributes
    ----------
    facings
        The combinations.
    points
        By name of a corner or middle: (g, 3) camera frame, metres.
    overreach_m
        (g,) sum of how much too long torso, hips and shoulders appear.
    pelvis, chest
        (g, 3, 3) global rotations of the two ends of the trunk, body frame axes.
    """

    facings: TrunkFacings
    points: Mapping[str, Float[np.ndarray, "g 3"]]
    overreach_m: Float[np.ndarray, " g"]
    pelvis: Float[np.ndarray, "g 3 3"]
    chest: Float[np.ndarray, "g 3 3"]


def trunk_readings(
    rig: LandmarkRig,
    lifting: Lifting,
    pixels: Pixels,
    lengths_m: Mapping[str, float],
    reference: Limb,
) -> TrunkReadings:
    """Lift the trunk in every way its image allows."""
    facings = _facings(between=reference.parent is not None)
    every = np.arange(len(facings.torso))
    depth = _pelvis_depth(lifting, pixels, lengths_m, reference, facings)
    pelvis = lifting.place(pixels[PELVIS_MIDDLE], depth)
    thorax_ends = lifting.reach(pelvis, pixels[THORAX_MIDDLE], lengths_m[TORSO])
    thorax = thorax_ends.points[every, facings.torso]
    hips = lifting.spread(depth, pixels[HIPS[0]], pixels[HIPS[1]], lengths_m["hips"])
    shoulders = lifting.spread(
        thorax[:, 2], pixels[SHOULDERS[0]], pixels[SHOULDERS[1]], lengths_m["shoulders"]
    )
    points = {
        PELVIS_MIDDLE: pelvis,
        THORAX_MIDDLE: thorax,
        HIPS[0]: hips.first[every, facings.hips],
        HIPS[1]: hips.second[every, facings.hips],
        SHOULDERS[0]: shoulders.first[every, facings.shoulders],
        SHOULDERS[1]: shoulders.second[every, facings.shoulders],
    }
    return TrunkReadings(
        facings=facings,
        points=points,
        overreach_m=thorax_ends.overreach_m + hips.overreach_m + shoulders.overreach_m,
        pelvis=_turned(rig, points, HIPS),
        chest=_turned(rig, points, SHOULDERS),
    )


def _facings(*, between: bool) -> TrunkFacings:
    choices = [[NEAR, FAR]] * 3 + ([[NEAR, FAR]] if between else [[NEAR]])
    torso, hips, shoulders, path = (axis.ravel() for axis in np.meshgrid(*choices, indexing="ij"))
    return TrunkFacings(torso=torso, hips=hips, shoulders=shoulders, between=path)


def _turned(
    rig: LandmarkRig, points: Mapping[str, Float[np.ndarray, "g 3"]], pair: tuple[str, str]
) -> Float[np.ndarray, "g 3 3"]:
    """Rotation from rest of the end of the trunk that carries this cross-piece."""
    right, left = pair
    rest = frames(
        rig.landmark(left) - rig.landmark(right),
        point_at_rest(rig, THORAX_MIDDLE) - point_at_rest(rig, PELVIS_MIDDLE),
    )
    seen = frames(
        (points[left] - points[right]) * CAMERA_AXES,
        (points[THORAX_MIDDLE] - points[PELVIS_MIDDLE]) * CAMERA_AXES,
    )
    return np.matmul(seen, rest.T)


def _pelvis_depth(
    lifting: Lifting,
    pixels: Pixels,
    lengths_m: Mapping[str, float],
    reference: Limb,
    facings: TrunkFacings,
) -> Float[np.ndarray, " g"]:
    """Walk from the reference limb, taken as parallel to the image, to the middle of the pelvis.

    Walking along a limb from its far end to its near one swaps NEAR and FAR.
    """
    every = np.arange(len(facings.torso))
    depth = np.full(
        len(every),
        lifting.parallel_depth(
            pixels[reference.proximal], pixels[reference.distal], lengths_m[reference.name]
        ),
    )
    if reference.name == TORSO:
        return depth
    point, name = lifting.place(pixels[reference.proximal], depth), reference.proximal
    if reference.parent is not None:
        parent = limb_named(reference.parent)
        ends = lifting.reach(point, pixels[parent.proximal], lengths_m[parent.name])
        point, name = ends.points[every, 1 - facings.between], parent.proximal
    if name in HIPS:
        return _middle_depth(lifting, pixels, HIPS, lengths_m["hips"], name, point, facings.hips)
    middle = _middle_depth(
        lifting, pixels, SHOULDERS, lengths_m["shoulders"], name, point, facings.shoulders
    )
    thorax = lifting.place(pixels[THORAX_MIDDLE], middle)
    ends = lifting.reach(thorax, pixels[PELVIS_MIDDLE], lengths_m[TORSO])
    return ends.points[every, 1 - facings.torso][:, 2]


def _middle_depth(
    lifting: Lifting,
    pixels: Pixels,
    pair: tuple[str, str],
    width_m: float,
    name: str,
    point: Float[np.ndarray, "g 3"],
    left_facing: Integer[np.ndarray, " g"],
) -> Float[np.ndarray, " g"]:
    """Depth of a cross-piece's middle from the position of one end."""
    right, left = pair
    opposite, facing = (right, 1 - left_facing) if name == left else (left, left_facing)
    ends = lifting.reach(point, pixels[opposite], width_m)
    other = ends.points[np.arange(len(point)), facing]
    return 0.5 * (point[:, 2] + other[:, 2])


_ABOVE = ("nose", "left_eye", "right_eye", "left_ear", "right_ear", "chin", "head_top", "neck")
_BELOW = ("left_knee", "right_knee", "left_ankle", "right_ankle")

Corners = Mapping[str, Float[np.ndarray, "2"]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrunkPoints:
    """Pixels of both shoulders, both hips and their middles, and which were guessed."""

    pixels: Corners
    guessed: frozenset[str]


def trunk_points(clicks: ClickedPoints, lengths_m: Mapping[str, float]) -> TrunkPoints:
    """Corners from clicks, completed.

    Raises
    ------
    InvalidInputError
        Where neither a shoulder nor a hip was clicked together with something to orient it by.
    """
    pixels = {
        name: pixel for name in (*SHOULDERS, *HIPS) if (pixel := clicks.pixel(name)) is not None
    }
    clicked = set(pixels)
    shoulders_to_hips = lengths_m["hips"] / lengths_m["shoulders"]
    _complete_pair(pixels, HIPS, SHOULDERS, shoulders_to_hips)
    _complete_pair(pixels, SHOULDERS, HIPS, 1.0 / shoulders_to_hips)
    if any(name in pixels for name in SHOULDERS) and any(name in pixels for name in HIPS):
        _fold_onto_seen_side(pixels)
    else:
        _add_missing_line(pixels, clicks, lengths_m)
    for name, (right, left) in MIDDLES.items():
        pixels[name] = 0.5 * (pixels[right] + pixels[left])
    return TrunkPoints(pixels=pixels, guessed=frozenset(pixels) - clicked - set(MIDDLES))


def _complete_pair(
    pixels: dict[str, Float[np.ndarray, "2"]],
    pair: tuple[str, str],
    other: tuple[str, str],
    ratio: float,
) -> None:
    """Give a pair with one end the slant of the complete other pair."""
    missing = [name for name in pair if name not in pixels]
    if len(missing) != 1 or not all(name in pixels for name in other):
        return
    across = (pixels[other[1]] - pixels[other[0]]) * ratio
    right, left = pair
    if missing[0] == left:
        pixels[left] = pixels[right] + across
    else:
        pixels[right] = pixels[left] - across


def _fold_onto_seen_side(pixels: dict[str, Float[np.ndarray, "2"]]) -> None:
    """A pair with one end left is seen from the side: the hidden end lies behind the other."""
    for right, left in (SHOULDERS, HIPS):
        if left not in pixels:
            pixels[left] = pixels[right]
        elif right not in pixels:
            pixels[right] = pixels[left]


def _add_missing_line(
    pixels: dict[str, Float[np.ndarray, "2"]],
    clicks: ClickedPoints,
    lengths_m: Mapping[str, float],
) -> None:
    """Add hips below shoulders, or shoulders above hips, along the body's long axis."""
    for pair, name, other, other_name, sign in (
        (SHOULDERS, "shoulders", HIPS, "hips", 1.0),
        (HIPS, "hips", SHOULDERS, "shoulders", -1.0),
    ):
        if not all(corner in pixels for corner in pair):
            continue
        right, left = pixels[pair[0]], pixels[pair[1]]
        middle, across = 0.5 * (right + left), left - right
        down = _down(clicks, middle, across)
        width = max(float(np.linalg.norm(across)), 1.0)
        centre = middle + sign * down * width * lengths_m[TORSO] / lengths_m[name]
        half = 0.5 * across * lengths_m[other_name] / lengths_m[name]
        pixels[other[0]], pixels[other[1]] = centre - half, centre + half
        return
    raise InvalidInputError(
        code="too-few-points",
        field="points",
        reason="The trunk cannot be placed: too few of shoulders and hips are given.",
        remedy="Click both shoulders or both hips, and as many other joints as can be seen.",
    )


def _down(
    clicks: ClickedPoints, middle: Float[np.ndarray, "2"], across: Float[np.ndarray, "2"]
) -> Float[np.ndarray, "2"]:
    """Unit direction from head to feet in the picture, perpendicular to the cross-piece.

    Where points above or below tell nothing, the person is taken to stand upright.
    """
    perpendicular = np.array([-across[1], across[0]])
    hint = np.array([0.0, 1e-6])
    for names, sign in ((_BELOW, 1.0), (_ABOVE, -1.0)):
        seen = clicks.only(names).pixels
        if len(seen):
            hint = hint + sign * (seen.mean(axis=0) - middle)
    if perpendicular @ hint < 0.0:
        perpendicular = -perpendicular
    length = float(np.linalg.norm(perpendicular))
    return perpendicular / length if length > 0.0 else np.array([0.0, 1.0])
