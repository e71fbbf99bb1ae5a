"""Rotations of another skeleton's joints relative to the parts that they move.

A part is turned by R_target = R_source A, with one A for the whole clip. A file's rest pose cannot
tell A: it may be a T-pose, the first frame, or every bone along one axis, with the same motion. If
a joint's frame is turned by B, R_source becomes R_source B, so A has to become B^-1 A. That holds
if A follows from directions in the world, seen in the joint's frame and averaged over the clip:

    u = Σ_t w(t) R_source(t)^T u(t),   v = Σ_t w(t) R_source(t)^T v(t),   A = [u v] [u0 v0]^T

where [u v] is the frame whose first axis is along u and whose second is nearest to v, and u0, v0
are the same directions of the person at rest. Directions come from positions of joints alone:

* *limbs*: the bone, which is exact in every frame, and the axis of the elbow or knee, which counts
  by the squared sine of its bend, and a little where an arm would bend forward and a leg back;
* *pelvis and chest*: the line of the hips or shoulders, and from the hips to the shoulders; the
  *spine* between them. Frames count by how straight hips and trunk are;
* *neck*: as the chest on the whole. *Head*: level, and facing as the chest, while the body stands;
* *hands*: as the forearm on the whole;
* *feet*: flat while they rest on the ground under an upright shin, along the bone to the toes.

So a habit that lasts for the whole clip, such as a head held to one side, cannot be told from a
skeleton whose neutral pose is like that, and is left out.
"""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.applications.poses import Rig
from fitter.arrays import Vector3
from fitter.numerics.rotations import cross_products, unit_vectors

STRAIGHT_LIMB_WEIGHT = 0.08
"""Weight of a straight limb's bending direction against the squared sine of a bend: 16 degrees."""

STILL_FOOT_LEGS_PER_SECOND = 0.3
"""A foot this fast counts 1/e of one that stands: 0.25 m/s."""

WEAK = 1e-3
"""Weight of frames that show little, for clips in which no frame shows more."""

_STANDING_SHARPNESS = 8
"""Power of (1 + cos)/2: a hip flexed by 45 degrees counts 0.28, by 90 degrees 0.004."""

_LEFT, _UP, _FORWARD = np.eye(3)

Directions = Float[np.ndarray, "t 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Samples:
    """Frames of a source in a world whose y is up, in lengths of its leg.

    Attributes
    ----------
    rotations, positions
        By part, (t, 3, 3) of the joint that moves it and (t, 3) of the joint.
    toes
        By side, (t, 3) the farthest point that is fixed to the foot; a foot may have none.
    foot_speed
        By side, (t,) of its ankle or toes, whichever is faster, legs a second.
    """

    rotations: Mapping[str, Float[np.ndarray, "t 3 3"]]
    positions: Mapping[str, Float[np.ndarray, "t 3"]]
    toes: Mapping[str, Float[np.ndarray, "t 3"]]
    foot_speed: Mapping[str, Float[np.ndarray, " t"]]


def alignments(samples: Samples, rig: Rig) -> dict[str, Float[np.ndarray, "3 3"]]:
    """A of every part that the source moves."""
    place = samples.positions
    hips = unit_vectors(place["left_thigh"] - place["right_thigh"])
    shoulders = unit_vectors(place["left_upper_arm"] - place["right_upper_arm"])
    trunk = unit_vectors(
        place["left_upper_arm"]
        + place["right_upper_arm"]
        - place["left_thigh"]
        - place["right_thigh"]
    )
    thighs = unit_vectors(
        place["left_shin"] + place["right_shin"] - place["left_thigh"] - place["right_thigh"]
    )
    straight = _sharp(-(trunk * thighs).sum(axis=1))[:, None] + WEAK
    standing = straight * (_sharp(trunk[:, 1])[:, None] + WEAK)
    found: dict[str, Float[np.ndarray, "3 3"]] = {}

    def align(
        part: str, first: Directions, second: Directions, at_rest: tuple[Vector3, Vector3]
    ) -> None:
        if part in samples.rotations:
            turned = samples.rotations[part]
            found[part] = _frame(_seen(turned, first), _seen(turned, second)) @ _frame(*at_rest).T

    rest_trunk = _rest_trunk(rig)
    align("pelvis", straight * hips, straight * trunk, (_LEFT, rest_trunk))
    align("spine", straight * trunk, straight * (hips + shoulders), (rest_trunk, _LEFT))
    align("chest", straight * trunk, straight * shoulders, (rest_trunk, _LEFT))
    forward = {
        "thigh": cross_products(hips, trunk),
        "upper_arm": cross_products(shoulders, trunk),
    }
    if "chest" in found:
        chest = samples.rotations["chest"] @ found["chest"]
        align("neck", straight * chest[:, :, 1], straight * chest[:, :, 0], (_UP, _LEFT))
    else:
        align("neck", straight * trunk, straight * shoulders, (rest_trunk, _LEFT))
    align("head", standing * _UP, standing * shoulders, (_UP, _LEFT))
    for side in ("left", "right"):
        for upper, lower, end in (("upper_arm", "forearm", "hand"), ("thigh", "shin", "foot")):
            parts = [f"{side}_{limb}" for limb in (upper, lower, end)]
            bones = [place[below] - place[above] for above, below in itertools.pairwise(parts)]
            axis = _bending_axis(bones[0], bones[1], forward[upper], backward=upper == "thigh")
            rest_axis = rig.prior.axes[rig.index(parts[1]), 0]
            for part, below, bone in zip(parts[:2], parts[1:], bones, strict=True):
                align(part, bone, axis, (rig.bone(part, below), rest_axis))
        forearm = samples.rotations[f"{side}_forearm"] @ found[f"{side}_forearm"]
        align(f"{side}_hand", forearm[:, :, 0], forearm[:, :, 1], (_LEFT, _UP))
        align(f"{side}_foot", *_foot(samples, side, found[f"{side}_shin"]), (_UP, _FORWARD))
    return found


def _rest_trunk(rig: Rig) -> Vector3:
    hips, shoulders = (
        rig.rest_joints[rig.index(f"left_{limb}")] + rig.rest_joints[rig.index(f"right_{limb}")]
        for limb in ("thigh", "upper_arm")
    )
    return shoulders - hips


def _bending_axis(
    upper: Directions, lower: Directions, forward: Directions, *, backward: bool
) -> Directions:
    """About which a limb bends: elbows forward, knees backward."""
    upper, lower = unit_vectors(upper), unit_vectors(lower)
    straight = cross_products(upper, forward) * (-1.0 if backward else 1.0)
    bent = cross_products(upper, lower)
    # By the square, or the small angle to the side that joints have on a straight limb would count.
    return np.linalg.norm(bent, axis=1)[:, None] * bent + STRAIGHT_LIMB_WEIGHT * straight


def _foot(
    samples: Samples, side: str, shin_alignment: Float[np.ndarray, "3 3"]
) -> tuple[Directions, Directions]:
    """Which way the instep's side and the toes of a foot point."""
    ankle = samples.positions[f"{side}_foot"]
    shin = unit_vectors(samples.positions[f"{side}_shin"] - ankle)
    stands = np.exp(-((samples.foot_speed[side] / STILL_FOOT_LEGS_PER_SECOND) ** 2))
    stands *= _sharp(shin[:, 1])
    up = stands[:, None] * _UP + WEAK * shin
    if side in samples.toes:
        return up, samples.toes[side] - ankle
    # A foot without toes points where the shin does.
    turned = samples.rotations[f"{side}_shin"] @ shin_alignment
    return up, turned[:, :, 2]


def _sharp(cosine: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    return (0.5 * (1.0 + cosine)) ** _STANDING_SHARPNESS


def _seen(turned: Float[np.ndarray, "t 3 3"], directions: Directions) -> Vector3:
    """Directions in a joint's frame, summed over the frames."""
    return np.einsum("tij,ti->j", turned, directions)


def _frame(first: Vector3, second: Vector3) -> Float[np.ndarray, "3 3"]:
    """Columns: along ``first``, as near to ``second`` as can be, and across both.

    Of directions that are none or the same, any frame will do.
    """
    first, second = unit_vectors(np.stack([first, second]))
    if not first.any():
        first = second if second.any() else _UP
    across = np.cross(first, second)
    if np.linalg.norm(across) < 1e-9:
        across = np.cross(first, np.eye(3)[int(np.argmin(np.abs(first)))])
    across = across / np.linalg.norm(across)
    return np.stack([first, np.cross(across, first), across], axis=1)
