"""A BVH file that is understood: its clip, which joint moves which part, and where it begins.

All that a motion can be refused for is refused here, in plain Python: first where the request is
accepted, and again, with the same words, where the job reads the file.

``skeletons.json`` beside this file holds how programs name the joints: in small letters, without
punctuation and without the ``prefixes`` that programs put before every name (regular expressions).
``{side}`` stands where left and right are written, in one of the ways under ``sides``. Where
several of the names listed for a part are there, the last one counts.

Plain Python, as :mod:`fitter.applications.bvh`.
"""

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from fitter.applications.bvh import FIELD, BvhFile, read_bvh
from fitter.errors import InvalidInputError

JOINTS_FIELD = "joints"
"""The request field that names joints by part."""

_SIDES = ("left", "right")
_LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")
NEEDED = ("pelvis", *(f"{side}_{limb}" for side in _SIDES for limb in _LIMBS))
"""Parts that a skeleton must move; trunk and head stay straight where it does not."""

PARTS = (*NEEDED, "spine", "chest", "neck", "head")

REQUEST = "the request"

_SHOWN_NAMES = 40


@dataclass(frozen=True, slots=True, kw_only=True)
class _Family:
    """A family's names: for each way to write the sides, those that may stand for each part."""

    name: str
    ways: tuple[Mapping[str, tuple[str, ...]], ...]


def plain_name(name: str) -> str:
    """A joint's name without namespace, program's prefix, case and punctuation."""
    _, prefix = _families()
    bare = prefix.sub("", name.rsplit(":", 1)[-1].strip().lower())
    return re.sub(r"[^a-z0-9]", "", bare)


def joints_of_parts(
    names: Sequence[str], named: Mapping[str, str] | None = None
) -> tuple[str, dict[str, int]]:
    """Whose names a skeleton has, and which joint moves each part.

    Parts of trunk and head that the skeleton lacks are left out. The names are a program's, or
    :data:`REQUEST`'s where the caller names all joints that are needed.

    Parameters
    ----------
    names
        Of the joints.
    named
        By part, the joint that the caller says; all others are found by their names.

    Raises
    ------
    InvalidInputError
        If the caller names a part or a joint that is not there, or hips or limbs cannot be told
        under any family's names.
    """
    told = _told(names, named or {})
    plain = {plain_name(name): joint for joint, name in reversed(list(enumerate(names)))}
    attempts: list[tuple[str, dict[str, int]]] = []
    for family in _families()[0]:
        for way in family.ways:
            found = {
                part: plain[[name for name in candidates if name in plain][-1]]
                for part, candidates in way.items()
                if any(name in plain for name in candidates)
            }
            attempts.append((family.name, found | told))
    complete = [attempt for attempt in attempts if attempt[1].keys() >= set(NEEDED)]
    if set(NEEDED) <= told.keys():
        # Families may still know the trunk.
        _, found = max(attempts, key=lambda attempt: len(attempt[1]))
        return REQUEST, found
    if not complete:
        raise _unknown(names, attempts)
    return max(complete, key=lambda attempt: len(attempt[1]))


def _told(names: Sequence[str], named: Mapping[str, str]) -> dict[str, int]:
    told: dict[str, int] = {}
    for part, name in named.items():
        if part not in PARTS:
            raise InvalidInputError(
                code="part-unknown",
                field=f"{JOINTS_FIELD}.{part}",
                reason="The body has no part of this name.",
                remedy=f"The parts are {', '.join(PARTS)}.",
            )
        if name not in names:
            raise InvalidInputError(
                code="bvh-skeleton-unknown",
                field=f"{JOINTS_FIELD}.{part}",
                reason=f"The file has no joint {name!r}. It has {_listed(names)}.",
                remedy="Name the joint as the file does.",
            )
        told[part] = names.index(name)
    return told


def _unknown(
    names: Sequence[str], attempts: Sequence[tuple[str, dict[str, int]]]
) -> InvalidInputError:
    nearest, found = max(attempts, key=lambda attempt: len(set(NEEDED) & attempt[1].keys()))
    missing = [part for part in NEEDED if part not in found]
    # With few of the parts found, likeness to a family is chance, and to name it would mislead.
    like = (
        f"The joints are named almost as by {nearest}, but none"
        if len(missing) <= len(NEEDED) // 2
        else "The joints are named as by no program that is known here: none"
    )
    known = ", ".join(family.name for family in _families()[0])
    example = f'{{"{missing[0]}": "the joint\'s name"}}'
    return InvalidInputError(
        code="bvh-skeleton-unknown",
        field="bvh",
        reason=f"{like} is the person's {', '.join(missing)}. The file has {_listed(names)}.",
        remedy=(
            f"Say in `{JOINTS_FIELD}` which joint moves which part, such as {example}, or name the "
            f"joints as one of these: {known}."
        ),
    )


def _listed(names: Sequence[str]) -> str:
    more = len(names) - _SHOWN_NAMES
    shown = ", ".join(name[:60] for name in names[:_SHOWN_NAMES])
    return f"{shown} and {more} more" if more > 0 else shown


@cache
def _families() -> tuple[tuple[_Family, ...], re.Pattern[str]]:
    """The families of the table, and what matches a prefix."""
    path = Path(__file__).with_name("skeletons.json")
    table: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    prefix = re.compile(rf"^({'|'.join(table['prefixes'])})")
    families = tuple(
        _Family(
            name=name,
            ways=tuple(_names_of_parts(entry["parts"], sides) for sides in entry["sides"]),
        )
        for name, entry in table["families"].items()
    )
    return families, prefix


def _names_of_parts(
    parts: Mapping[str, Sequence[str]], sides: Sequence[str]
) -> dict[str, tuple[str, ...]]:
    names: dict[str, tuple[str, ...]] = {}
    for part, patterns in parts.items():
        if part in _LIMBS:
            for ours, theirs in zip(_SIDES, sides, strict=True):
                names[f"{ours}_{part}"] = tuple(name.format(side=theirs) for name in patterns)
        else:
            names[part] = tuple(patterns)
    return names


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
        code="bvh-skeleton-unknown", field=JOINTS_FIELD, reason=f"{reason}.", remedy=remedy
    )
