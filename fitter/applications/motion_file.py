"""A BVH file that is understood: its clip, which joint moves which part, and where it begins.

All that a motion can be refused for is refused here, in plain Python: first where the request is
accepted, and again, with the same words, where the job reads the file.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from fitter.applications.bvh import FIELD, BvhFile, read_bvh
from fitter.applications.skeletons import joints_of_parts
from fitter.errors import InvalidInputError

FARTHEST_LEGS = 1000.0
"""From where a clip begins, in lengths of a leg; farther goes only a file whose positions are in
another unit than its bones. No bone is longer either."""

SHORTEST_LEG = 1e-6
"""In the file's unit; below it a scale has no meaning."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MotionFile:
    """A file's clip and how it moves a person.

    Attributes
    ----------
    clip
        As it was read.
    naming
        Whose names the joints have: a program's, or the request's.
    joints
        By part of the body, the joint that moves it. Parts of the trunk may be missing.
    leg
        Length of a leg, the mean of both, in the file's unit.
    first
        The frame with which the stretch begins.
    """

    clip: BvhFile
    naming: str
    joints: Mapping[str, int]
    leg: float
    first: int


def read_motion(
    content: bytes, *, named: Mapping[str, str] | None = None, start_s: float = 0.0
) -> MotionFile:
    """Read a motion.

    Parameters
    ----------
    content
        Of the BVH file.
    named
        By part, the joint that the caller says moves it; others are found by their names.
    start_s
        Where the stretch begins.

    Raises
    ------
    InvalidInputError
        If the file cannot be read, its joints cannot be told, it has no legs, goes too far, or ends
        before the stretch begins.
    """
    clip = read_bvh(content)
    naming, joints = joints_of_parts(clip.names, named)
    leg = _leg(clip, joints)
    _check_reach(clip, leg)
    return MotionFile(
        clip=clip, naming=naming, joints=joints, leg=leg, first=_first_frame(clip, start_s)
    )


def _leg(clip: BvhFile, joints: Mapping[str, int]) -> float:
    """Lengths of bones do not depend on the pose that the file calls rest."""
    length = 0.0
    for side in ("left", "right"):
        thigh, shin, foot = (joints[f"{side}_{limb}"] for limb in ("thigh", "shin", "foot"))
        for above, below, name in ((thigh, shin, "shin"), (shin, foot, "foot")):
            joint = below
            while joint > above:
                length += math.hypot(*clip.offsets[joint])
                joint = clip.parents[joint]
            if joint != above or below == above:
                raise _unusable(
                    reason=(
                        f"The {side} {name}'s joint {clip.names[below]!r} does not hang on the "
                        f"joint {clip.names[above]!r}"
                    ),
                    remedy="Name the joints of one person's legs.",
                )
    if length < 2.0 * SHORTEST_LEG:
        raise _unusable(
            reason="The skeleton's legs have no length", remedy="Export the skeleton's bones too."
        )
    return 0.5 * length


def _check_reach(clip: BvhFile, leg: float) -> None:
    farthest = FARTHEST_LEGS * leg
    if any(math.hypot(*offset) > farthest for offset in (*clip.offsets[1:], *clip.ends)):
        raise _too_far(what="A bone is", leg=leg)
    width = sum(map(len, clip.channels))
    column = 0
    for joint, channels in enumerate(clip.channels):
        for channel in channels:
            if channel.endswith("position"):
                places = clip.numbers[column::width]
                # The root may be anywhere, but does not leave it; bones have a length.
                least, most = min(places), max(places)
                if (most - least if joint == 0 else max(-least, most)) > farthest:
                    raise _too_far(what="The body moves" if joint == 0 else "A bone grows", leg=leg)
            column += 1


def _first_frame(clip: BvhFile, start_s: float) -> int:
    begins = start_s / clip.frame_time_s
    if not 0.0 <= begins < clip.frames - 0.5:
        length_s = clip.frames * clip.frame_time_s
        raise InvalidInputError(
            code="stretch-outside-clip",
            field="start_s",
            reason=f"The clip is {length_s:.2f} s long and {start_s:g} s is not within it.",
            remedy="Begin within the clip.",
        )
    return round(begins)


def _too_far(*, what: str, leg: float) -> InvalidInputError:
    return InvalidInputError(
        code="bvh-too-far",
        field=FIELD,
        reason=(
            f"{what} more than {FARTHEST_LEGS:g} times as far as a leg is long, which is {leg:.3g} "
            "in the file's unit."
        ),
        remedy="Export hips and offsets in the same unit.",
    )


def _unusable(*, reason: str, remedy: str) -> InvalidInputError:
    return InvalidInputError(
        code="bvh-skeleton-unknown", field=FIELD, reason=f"{reason}.", remedy=remedy
    )
