"""Where the trunk can be: every reading of its slant, with the root's depth.

Three things are ambiguous: whether the torso leans toward the camera or away, and which hip and
which shoulder is nearer. Whether the view is from the front or the back is not: it follows from
the order of left and right. A reference limb two steps from the trunk adds the facing of the limb
in between.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.body.scape import CAMERA_AXES
from fitter.pose_init.directions import frames
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.lifting import FAR, NEAR, Lifting
from fitter.pose_init.limbs import (
    HIPS,
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
