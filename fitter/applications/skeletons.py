"""Which joint of a BVH file's skeleton moves which part of a person.

``skeletons.json`` beside this file holds how programs name the joints: in small letters, without
punctuation and without the ``prefixes`` that programs put before every name (regular expressions).
``{side}`` stands where left and right are written, in one of the ways under ``sides``. Where
several of the names listed for a part are there, the last one counts.

Plain Python, as :mod:`fitter.applications.bvh`.
"""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from fitter.errors import InvalidInputError

FIELD = "joints"
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
                field=f"{FIELD}.{part}",
                reason="The body has no part of this name.",
                remedy=f"The parts are {', '.join(PARTS)}.",
            )
        if name not in names:
            raise InvalidInputError(
                code="bvh-skeleton-unknown",
                field=f"{FIELD}.{part}",
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
            f"Say in `{FIELD}` which joint moves which part, such as {example}, or name the joints "
            f"as one of these: {known}."
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
