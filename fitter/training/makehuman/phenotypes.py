"""MakeHuman's macro parameters: which targets a phenotype mixes, and by how much.

A macro target stands for one combination of factors, such as (female, old, maxmuscle, minweight,
maxheight). Its coefficient is the product of one hat function per factor, so that along every
parameter the body is piecewise linear between the combinations that artists sculpted. The product
is that of anny's forward model, to rounding.
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
"""Where a macro parameter may pass the last anchor. MakeHuman's heaviest body is short of a body
mass index of 32 or so in subjects of little muscle; beyond it the same change goes on."""

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
