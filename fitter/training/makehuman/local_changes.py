"""Local changes of MakeHuman's body and face, left and right tied together."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class LocalChange:
    """A change of one region with two opposite directions.

    ``positive`` and ``negative`` are the targets that make it up: one, or a left and a right one.
    """

    name: str
    positive: tuple[str, ...]
    negative: tuple[str, ...]


_BODY = (
    "arms/measure-upperarm-length",
    "arms/measure-lowerarm-length",
    "arms/measure-upperarm-circ",
    "hands/measure-wrist-circ",
    "feet/measure-ankle-circ",
    "legs/measure-calf-circ",
    "legs/measure-lowerleg-height",
    "legs/measure-upperleg-height",
    "legs/measure-knee-circ",
    "legs/measure-thigh-circ",
    "legs/upperlegs-height",
    "legs/lowerlegs-height",
    "neck/measure-neck-circ",
    "neck/measure-neck-height",
    "neck/neck-double",
    "neck/neck-scale-depth",
    "torso/measure-underbust-circ",
    "torso/measure-napetowaist-dist",
    "torso/measure-waisttohip-dist",
    "torso/measure-shoulder-dist",
    "torso/measure-hips-circ",
    "torso/measure-waist-circ",
    "torso/measure-frontchest-dist",
    "torso/measure-bust-circ",
    "torso/torso-scale-horiz",
    "torso/torso-scale-depth",
    "torso/torso-scale-vert",
    "torso/torso-vshape",
    "torso/torso-muscle-pectoral",
    "torso/torso-muscle-dorsi",
    "hip/hip-scale-horiz",
    "hip/hip-scale-depth",
    "hip/hip-scale-vert",
    "hip/hip-waist:up:down",
    "hip/hip-trans:forward:backward",
    "buttocks/buttocks-volume",
    "stomach/stomach-tone",
    "stomach/stomach-pregnant",
    "pelvis/pelvis-tone",
    "head/head-scale-horiz",
    "head/head-scale-depth",
    "head/head-scale-vert",
    "head/head-fat",
    "arms/*upperarm-fat",
    "arms/*upperarm-muscle",
    "arms/*upperarm-shoulder-muscle",
    "arms/*lowerarm-fat",
    "arms/*lowerarm-muscle",
    "arms/*lowerarm-scale-horiz",
    "arms/*lowerarm-scale-depth",
    "legs/*upperleg-fat",
    "legs/*upperleg-muscle",
    "legs/*lowerleg-fat",
    "legs/*lowerleg-muscle",
    "hands/*hand-scale",
    "hands/*hand-fingers-length",
    "feet/*foot-scale",
    "feet/*foot-scale-depth",
)

_BREAST = ("breast/breast-dist", "breast/breast-trans:up:down", "breast/breast-volume-vert:up:down")

_FACE = (
    "nose/nose-scale-horiz",
    "nose/nose-scale-vert",
    "nose/nose-scale-depth",
    "nose/nose-curve:convex:concave",
    "nose/nose-trans:up:down",
    "mouth/mouth-scale-horiz",
    "mouth/mouth-trans:up:down",
    "mouth/mouth-lowerlip-volume",
    "mouth/mouth-upperlip-volume",
    "chin/chin-width",
    "chin/chin-height",
    "chin/chin-prominent",
    "chin/chin-jaw-drop",
    "forehead/forehead-trans:forward:backward",
    "forehead/forehead-temple",
    "eyebrows/eyebrows-trans:up:down",
    "cheek/*cheek-bones",
    "cheek/*cheek-volume",
    "ears/*ear-scale",
    "ears/*ear-wing",
    "eyes/*eye-scale",
    "eyes/*eye-trans:up:down",
)


def local_changes(gender: str) -> tuple[LocalChange, ...]:
    """The changes that measurements decide, for ``female`` or ``male``."""
    return tuple(_change(pattern) for pattern in (*_BODY, *(_BREAST if gender == "female" else ())))


def _change(pattern: str) -> LocalChange:
    """``*`` stands for both sides; ``stem:up:down`` names directions other than incr and decr."""
    stem, _, directions = pattern.partition(":")
    up, _, down = directions.partition(":") if directions else ("incr", ":", "decr")
    sides = ("l-", "r-") if "*" in stem else ("",)
    return LocalChange(
        name=stem.split("/")[1].lstrip("*"),
        positive=tuple(f"{stem.replace('*', side)}-{up}" for side in sides),
        negative=tuple(f"{stem.replace('*', side)}-{down}" for side in sides),
    )


FACE_CHANGES = tuple(_change(pattern) for pattern in _FACE)
"""Changes drawn at random for variety."""
