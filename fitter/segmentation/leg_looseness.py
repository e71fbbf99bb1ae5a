"""Whether what covers the legs stands off them, by how far the outline is from their bones.

At a level of a bone its reach is the distance to the outline, across the bone, on the nearer side:
the other may meet the other leg. It is the mean over a stretch of the bone, for one line would move
by a pixel or two when the picture is saved again. Reaches of bare legs and of legs in trousers,
skirts and shorts are about normal; Bayes' rule compares them. Levels of one leg tell much the same,
so that together they count as :data:`INDEPENDENT` of them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.stats import trim_mean

from fitter.arrays import GreyImage, Mask


@dataclass(frozen=True, slots=True, kw_only=True)
class Level:
    """A level of a leg, and mean and deviation of its reach, metres: bare, and in loose clothes."""

    near: str
    far: str
    along: float
    bare: tuple[float, float]
    loose: tuple[float, float]


# Bare: 90 pictures of the suite's and of other bodies. Loose: 17 of both kinds in clothes.
LEVELS: Final = (
    Level(near="thigh", far="shin", along=0.6, bare=(0.074, 0.014), loose=(0.103, 0.02)),
    Level(near="thigh", far="shin", along=0.9, bare=(0.058, 0.011), loose=(0.094, 0.02)),
    Level(near="shin", far="foot", along=0.6, bare=(0.033, 0.008), loose=(0.072, 0.02)),
    Level(near="shin", far="foot", along=0.85, bare=(0.024, 0.006), loose=(0.061, 0.02)),
)

INDEPENDENT: Final = 2.0
_ENOUGH_OF_SHINS: Final = 1.0
_LOOSE_LEGS: Final = 0.8
"""Prior probability that what covers legs is loose."""

_LEAST_LENGTH_M = 0.15
"""A bone that is seen shorter points at the camera, where its reaches mean nothing."""

_FARTHEST_M = 0.25
_STEP_PX = 0.5

_STRETCH: Final = np.linspace(-0.07, 0.07, 9)
"""Places about a level where its reach is taken, as shares of the bone's length; the quarter that
differs most on either side is left out."""
_LEFT_OUT: Final = 0.25


def legs_are_loose(
    person: Mask,
    bare: GreyImage,
    joints: Mapping[str, Float[np.ndarray, "2"]],
    pixels_per_metre: float,
) -> float:
    """Probability that clothes stand off the legs, if there are any.

    ``joints`` are continuous pixels by part, as far as they are known; levels count as far as they
    are not ``bare``.
    """
    weighted, levels = 0.0, 0.0
    # Thighs differ most between people: where shins are covered too, these tell more.
    for level in sorted(LEVELS, key=lambda each: each.near != "shin"):
        if level.near != "shin" and levels >= _ENOUGH_OF_SHINS:
            break
        told = _least_reach(person, bare, joints, pixels_per_metre, level)
        if told is None:
            continue
        reach, share = told
        (close, spread), (wide, widely) = level.bare, level.loose
        # Farther than loose clothes is looser still, nearer than a bare leg is thinner still.
        loose = _log_density(min(reach, wide), wide, widely)
        weighted += share * (loose - _log_density(max(reach, close), close, spread))
        levels += share
    evidence = weighted * min(1.0, INDEPENDENT / levels) if levels else 0.0
    return float(1.0 / (1.0 + np.exp(-evidence - np.log(_LOOSE_LEGS / (1.0 - _LOOSE_LEGS)))))


def _log_density(reach: float, mean: float, deviation: float) -> float:
    return -np.log(deviation) - 0.5 * min(((reach - mean) / deviation) ** 2, 9.0)


def _least_reach(
    person: Mask,
    bare: GreyImage,
    joints: Mapping[str, Float[np.ndarray, "2"]],
    pixels_per_metre: float,
    level: Level,
) -> tuple[float, float] | None:
    """The nearer leg's reach, metres, and how probable it is that both are covered there."""
    found: list[float] = []
    covered: list[float] = []
    for side in ("left", "right"):
        ends = f"{side}_{level.near}", f"{side}_{level.far}"
        if any(end not in joints for end in ends):
            continue
        near, far = (joints[end] for end in ends)
        bone = far - near
        length = float(np.linalg.norm(bone))
        if length < _LEAST_LENGTH_M * pixels_per_metre:
            continue
        across = np.array([-bone[1], bone[0]]) / length
        places = near + (level.along + _STRETCH)[:, None] * bone
        if (places < 0.0).any() or (places >= person.shape[::-1]).any():
            # Beyond the picture nothing is seen, which is not a thin leg.
            continue
        most = _FARTHEST_M * pixels_per_metre
        covered.append(1.0 - float(np.mean([_nearest_value(bare, place) for place in places])))
        found.extend(
            float(trim_mean([_reach(person, place, way, most) for place in places], _LEFT_OUT))
            for way in (across, -across)
        )
    return (min(found) / pixels_per_metre, min(covered)) if found else None


def _nearest_value(image: GreyImage, place: Float[np.ndarray, "2"]) -> float:
    height, width = image.shape
    column, row = np.floor(place).astype(int)
    return float(image[min(max(row, 0), height - 1), min(max(column, 0), width - 1)])


def _reach(
    person: Mask, start: Float[np.ndarray, "2"], along: Float[np.ndarray, "2"], most: float
) -> float:
    """Distance that the mask goes on from a place in a direction, pixels."""
    height, width = person.shape
    distances = np.arange(0.0, most, _STEP_PX)
    columns, rows = np.floor(start + distances[:, None] * along).astype(int).T
    inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    covered = np.zeros(len(distances), bool)
    covered[inside] = person[rows[inside], columns[inside]]
    return _STEP_PX * float(np.argmin(covered)) if not covered.all() else most
