"""The trunk's four corners in the picture, completed where a click is missing.

A body partly outside the picture, or a shoulder hidden behind the head, must not end the fit:
a missing corner is placed as the other cross-piece suggests. Guessed corners only start the pose;
the refinement never sees them.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.errors import InvalidInputError
from fitter.pose_init.limbs import HIPS, MIDDLES, SHOULDERS, TORSO
from fitter.pose_init.points import ClickedPoints

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
