"""How programs that write BVH files name the joints of a person."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from fitter.errors import InvalidInputError

_LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")
_NEEDED = ("pelvis", *(f"{s}_{limb}" for s in ("left", "right") for limb in _LIMBS))


@dataclass(frozen=True, slots=True, kw_only=True)
class Naming:
    """Names of one program, in small letters without prefixes and punctuation.

    Attributes
    ----------
    trunk
        By part; where several names may stand for a part, the last that is there does.
    limbs
        By limb, with ``{side}`` where the side stands.
    sides
        How left and right are written.
    """

    name: str
    trunk: Mapping[str, tuple[str, ...]]
    limbs: Mapping[str, str]
    sides: tuple[str, str]

    def parts(self) -> dict[str, tuple[str, ...]]:
        """Names that may stand for each part."""
        names = dict(self.trunk)
        for part_side, side in zip(("left", "right"), self.sides, strict=True):
            for limb, pattern in self.limbs.items():
                names[f"{part_side}_{limb}"] = (pattern.format(side=side),)
        return names


def _limbs(*names: str) -> Mapping[str, str]:
    return MappingProxyType(dict(zip(_LIMBS, names, strict=True)))


_NECK_AND_HEAD = {"neck": ("neck", "neck1"), "head": ("head",)}

NAMINGS = (
    Naming(
        name="CMU",
        trunk={
            "pelvis": ("hips",),
            "spine": ("lowerback",),
            "chest": ("chest", "chest2", "chest3", "chest4"),
            **_NECK_AND_HEAD,
        },
        limbs=_limbs(
            "{side}shoulder",
            "{side}elbow",
            "{side}wrist",
            "{side}hip",
            "{side}knee",
            "{side}ankle",
        ),
        sides=("left", "right"),
    ),
    Naming(
        name="Mixamo",
        trunk={
            "pelvis": ("hips",),
            "spine": ("spine", "lowerback"),
            "chest": ("spine1", "spine2", "spine3"),
            **_NECK_AND_HEAD,
        },
        limbs=_limbs(
            "{side}arm", "{side}forearm", "{side}hand", "{side}upleg", "{side}leg", "{side}foot"
        ),
        sides=("left", "right"),
    ),
    Naming(
        name="Rokoko",
        trunk={
            "pelvis": ("hip", "hips"),
            "spine": ("spine", "spine1"),
            "chest": ("spine2", "spine3", "spine4", "chest"),
            **_NECK_AND_HEAD,
        },
        limbs=_limbs(
            "{side}arm", "{side}forearm", "{side}hand", "{side}thigh", "{side}shin", "{side}foot"
        ),
        sides=("left", "right"),
    ),
    Naming(
        name="Blender Rigify",
        trunk={
            "pelvis": ("spine",),
            "spine": ("spine001",),
            "chest": ("spine002", "spine003"),
            "neck": ("spine004", "spine005"),
            "head": ("spine006",),
        },
        limbs=_limbs(
            "upperarm{side}",
            "forearm{side}",
            "hand{side}",
            "thigh{side}",
            "shin{side}",
            "foot{side}",
        ),
        sides=("l", "r"),
    ),
    Naming(
        name="Blender",
        trunk={
            "pelvis": ("hips", "pelvis"),
            "spine": ("spine",),
            "chest": ("chest", "upperchest"),
            **_NECK_AND_HEAD,
        },
        limbs=_limbs(
            "upperarm{side}",
            "forearm{side}",
            "hand{side}",
            "thigh{side}",
            "shin{side}",
            "foot{side}",
        ),
        sides=("l", "r"),
    ),
)
"""CMU: the cgspeed conversions, whose second kind names like Mixamo."""


def plain_name(name: str) -> str:
    """A joint's name without namespace, program's prefix, case and punctuation."""
    bare = name.rsplit(":", 1)[-1].strip().lower()
    bare = re.sub(r"^(mixamorig\d*|def-|org-)", "", bare)
    return re.sub(r"[^a-z0-9]", "", bare)


def joints_of_parts(names: Sequence[str], *, field: str) -> tuple[str, dict[str, int]]:
    """Which program's names a skeleton has, and which joint moves each part.

    Parts of trunk and head that the skeleton lacks are left out.

    Raises
    ------
    InvalidInputError
        If hips or limbs cannot be told under any naming.
    """
    plain = [plain_name(name) for name in names]
    attempts: list[tuple[str, list[str]]] = []
    for naming in NAMINGS:
        found: dict[str, int] = {}
        for part, candidates in naming.parts().items():
            there = [candidate for candidate in candidates if candidate in plain]
            if there:
                found[part] = plain.index(there[-1])
        missing = [part for part in _NEEDED if part not in found]
        if not missing:
            return naming.name, found
        attempts.append((naming.name, missing))
    nearest, missing = min(attempts, key=lambda attempt: len(attempt[1]))
    raise InvalidInputError(
        code="bvh-skeleton-unknown",
        field=field,
        reason=(
            f"The skeleton's names are most like those of {nearest}, but no joint is the person's "
            f"{', '.join(missing)}."
        ),
        remedy=(
            "Name the joints as CMU, Mixamo, Rokoko or Blender do, such as Hips, LeftUpLeg, "
            "LeftLeg, LeftFoot, LeftArm, LeftForeArm, LeftHand."
        ),
    )
