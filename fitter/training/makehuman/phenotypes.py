"""MakeHuman's parameters: which targets a phenotype mixes, by how much, and local changes.

A macro target stands for one combination of factors, such as (female, old, maxmuscle, minweight,
maxheight). Its coefficient is the product of one hat function per factor, so that along every
parameter the body is piecewise linear between the combinations that artists sculpted. The product
is that of anny's forward model, to rounding. Local changes move one region, left and right
together.
"""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

AXES: Mapping[str, tuple[str, ...]] = {
    "age": ("young", "old"),
    "ancestry": ("african", "asian", "caucasian"),
    "muscle": ("minmuscle", "averagemuscle", "maxmuscle"),
    "weight": ("minweight", "averageweight", "maxweight"),
    "height": ("minheight", "maxheight"),
    "proportions": ("idealproportions", "uncommonproportions"),
    "cupsize": ("mincup", "averagecup", "maxcup"),
    "firmness": ("minfirmness", "averagefirmness", "maxfirmness"),
}

YOUNG_AGE = 2.0 / 3.0
"""MakeHuman's age axis runs newborn -1/3, baby 0, child 1/3, young 2/3, old 1."""

YOUNG_YEARS, OLD_YEARS = 25.0, 90.0
"""Years that MakeHuman's young and old bodies stand for."""

ANCHORS: Mapping[str, tuple[float, ...]] = {
    "age": (YOUNG_AGE, 1.0),
    **{
        axis: tuple(np.linspace(0.0, 1.0, len(labels)).tolist())
        for axis, labels in AXES.items()
        if axis not in ("age", "ancestry")
    },
}

UPPER_BOUNDS: Mapping[str, float] = {"weight": 1.6}
"""Bounds of macro parameters that may pass the last anchor. MakeHuman's heaviest body is short of a
body mass index of 32 or so in subjects of little muscle; beyond it the same change goes on."""

FREE_AXES = ("muscle", "weight", "height", "proportions", "cupsize", "firmness")
"""Macro parameters that a subject's measurements decide; age and ancestry are traits."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MacroTargets:
    """The macro targets of one gender.

    Attributes
    ----------
    names
        Paths under ``targets`` without ending; k of them.
    members
        (k, axes) which label of each axis of :data:`AXES` the target stands for, -1 for none.
    """

    names: tuple[str, ...]
    members: Integer[np.ndarray, "k a"]


def macro_targets(gender: str) -> MacroTargets:
    """All adult macro targets of ``female`` or ``male``."""
    folder = "macrodetails"
    blocks: list[tuple[tuple[str, ...], str]] = [
        (("ancestry", "age"), f"{folder}/{{0}}-{gender}-{{1}}"),
        (("age", "muscle", "weight"), f"{folder}/universal-{gender}-{{0}}-{{1}}-{{2}}"),
    ]
    blocks += [
        (("age", "muscle", "weight", axis), f"{folder}/{axis}/{gender}-{{0}}-{{1}}-{{2}}-{{3}}")
        for axis in ("height", "proportions")
    ]
    if gender == "female":
        axes = ("age", "muscle", "weight", "cupsize", "firmness")
        blocks.append((axes, f"breast/{gender}-{{0}}-{{1}}-{{2}}-{{3}}-{{4}}"))
    names: list[str] = []
    members: list[list[int]] = []
    for axes, pattern in blocks:
        for labels in itertools.product(*(AXES[axis] for axis in axes)):
            if "averagecup" in labels and "averagefirmness" in labels:
                continue  # the breast of the universal target itself
            names.append(pattern.format(*labels))
            chosen = dict(zip(axes, labels, strict=True))
            members.append(
                [AXES[axis].index(chosen[axis]) if axis in chosen else -1 for axis in AXES]
            )
    return MacroTargets(names=tuple(names), members=np.array(members))


def free_axes(gender: str) -> tuple[str, ...]:
    """The macro parameters of one gender."""
    return FREE_AXES if gender == "female" else FREE_AXES[:4]


def age_of_appearance(years: float) -> float:
    """MakeHuman's age parameter of an adult."""
    share = (years - YOUNG_YEARS) / (OLD_YEARS - YOUNG_YEARS)
    return float(YOUNG_AGE + (1.0 - YOUNG_AGE) * np.clip(share, 0.0, 1.0))


def hat_weights(value: float, anchors: Sequence[float]) -> Float[np.ndarray, " n"]:
    """Weights of the anchors at a value: linear between them and beyond them, summing to one."""
    segment = _segment(value, anchors)
    share = (value - anchors[segment]) / (anchors[segment + 1] - anchors[segment])
    weights = np.zeros(len(anchors))
    weights[[segment, segment + 1]] = 1.0 - share, share
    return weights


def hat_slopes(value: float, anchors: Sequence[float]) -> Float[np.ndarray, " n"]:
    """Derivative of :func:`hat_weights`; at an anchor, that of the segment above it."""
    segment = _segment(value, anchors)
    rise = 1.0 / (anchors[segment + 1] - anchors[segment])
    slopes = np.zeros(len(anchors))
    slopes[[segment, segment + 1]] = -rise, rise
    return slopes


def _segment(value: float, anchors: Sequence[float]) -> int:
    return int(np.clip(np.searchsorted(anchors, value, side="right") - 1, 0, len(anchors) - 2))


def macro_coefficients(
    targets: MacroTargets,
    *,
    age: float,
    ancestry: Float[np.ndarray, "3"],
    values: Mapping[str, float],
) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, "k q"]]:
    """Coefficients of the macro targets and their derivative by ``values``, in their order."""
    weights = {axis: hat_weights(value, ANCHORS[axis]) for axis, value in values.items()}
    weights["age"] = hat_weights(age, ANCHORS["age"])
    weights["ancestry"] = ancestry
    factors = np.ones(targets.members.shape)
    for column, axis in enumerate(AXES):
        belongs = targets.members[:, column] >= 0
        if belongs.any():
            factors[belongs, column] = weights[axis][targets.members[belongs, column]]
    derivative = np.zeros((len(targets.names), len(values)))
    for parameter, (axis, value) in enumerate(values.items()):
        column = list(AXES).index(axis)
        belongs = targets.members[:, column] >= 0
        slopes = hat_slopes(value, ANCHORS[axis])[targets.members[belongs, column]]
        others = np.delete(factors[belongs], column, axis=1).prod(axis=1)
        derivative[belongs, parameter] = slopes * others
    return factors.prod(axis=1), derivative


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
