"""Colours of skin, hair and cloth, and the patterns of cloths, as linear albedo."""

from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.training.dressed.surfaces import Paint, Places, noise

Rgb = Float[np.ndarray, "3"]

SKINS: Final = np.array(
    [
        [0.72, 0.47, 0.36],
        [0.60, 0.37, 0.26],
        [0.45, 0.26, 0.17],
        [0.27, 0.14, 0.08],
        [0.13, 0.065, 0.04],
        [0.07, 0.037, 0.025],
    ]
)
"""From the lightest skin to the darkest."""

DENIM: Final = np.array([0.045, 0.075, 0.16])

ARM_LENGTH_M: Final = 0.55


def skin_colour(rng: np.random.Generator) -> Rgb:
    """Any tone, as often dark as light."""
    at = 4.6 * rng.random()
    tone = np.array([np.interp(at, range(len(SKINS)), SKINS[:, k]) for k in range(3)])
    return np.clip(tone * _about(rng, 0.08, 0.04), 0.01, 0.85)


def hair_colour(rng: np.random.Generator) -> Rgb:
    """Mostly dark, some fair or grey, a few dyed."""
    kind = rng.random()
    if kind < 0.06:
        return np.full(3, rng.uniform(0.2, 0.6))
    if kind < 0.09:
        return cloth_colour(rng)
    lighter = abs(rng.normal(0.0, 1.1)) * np.array([1.0, 0.9, 0.75])
    return np.clip(np.exp(rng.normal([-3.6, -3.9, -4.2], 0.15) + lighter), 0.006, 0.6)


def cloth_colour(rng: np.random.Generator) -> Rgb:
    """White, black, grey, skin's colours and warmer ones, denim, or anything."""
    kind = rng.random()
    if kind < 0.18:
        colour = rng.uniform(0.45, 0.85) * _about(rng, 0.0, 0.04)
    elif kind < 0.38:
        colour = np.exp(rng.uniform(np.log(0.008), np.log(0.05))) * _about(rng, 0.0, 0.1)
    elif kind < 0.5:
        colour = np.exp(rng.uniform(np.log(0.05), np.log(0.45))) * _about(rng, 0.0, 0.08)
    elif kind < 0.62:
        colour = skin_colour(rng) * _about(rng, 0.18, 0.12)
    elif kind < 0.76:
        colour = _warm(rng)
    elif kind < 0.85:
        colour = 1.2 * DENIM * _about(rng, 0.7, 0.15)
    else:
        hue = 0.5 + 0.5 * np.cos(rng.uniform(0.0, 2.0 * np.pi) + np.array([0.0, 2.1, 4.2]))
        strength = rng.uniform(0.3, 1.0)
        light = np.exp(rng.uniform(np.log(0.05), np.log(0.6)))
        colour = light * (1.0 - strength + strength * hue) ** 1.5
    return np.clip(colour, 0.004, 0.88)


def cloth_colour_near_skin(rng: np.random.Generator) -> Rgb:
    """Warm, or one of skin's, or any in a quarter of cases: what is taken for skin most easily."""
    kind = rng.random()
    if kind < 0.45:
        return _warm(rng)
    return skin_colour(rng) * _about(rng, 0.2, 0.12) if kind < 0.75 else cloth_colour(rng)


def _warm(rng: np.random.Generator) -> Rgb:
    """Yellow, orange, red, rust."""
    hue = np.array([1.0, rng.uniform(0.25, 0.75), rng.uniform(0.03, 0.35)])
    return np.exp(rng.uniform(np.log(0.08), np.log(0.8))) * hue


def _about(rng: np.random.Generator, light: float, hue: float) -> Rgb:
    """Factors about one: a common one, and one for each channel."""
    return np.exp(rng.normal(0.0, light) + rng.normal(0.0, hue, 3))


PATTERNS: Final = (
    "across",
    "down",
    "plaid",
    "camouflage",
    "print",
    "washed",
    "flecks",
)


def cloth(rng: np.random.Generator, *, plain: float = 0.5, colour: Rgb | None = None) -> Paint:
    """A cloth of one colour, with probability ``plain``, or of a pattern of up to three."""
    first = cloth_colour(rng) if colour is None else colour
    pattern = "plain" if rng.random() < plain else str(rng.choice(PATTERNS))
    second, third = cloth_colour(rng), cloth_colour(rng)
    if rng.random() < 0.5:
        second = np.clip(first * _about(rng, 0.0, 0.6), 0.004, 0.88)
    repeat_m, check_m = np.exp(rng.uniform(np.log([0.012, 0.02]), np.log([0.12, 0.1])))
    duty, height = rng.uniform(-0.7, 0.7), rng.uniform(0.05, 0.35)
    middle, half_x, half_y = rng.normal(0.0, 0.03), rng.uniform(0.04, 0.16), rng.uniform(0.03, 0.16)
    seed = int(rng.integers(1 << 30))

    def paint(at: Places) -> Float[np.ndarray, "k 3"]:
        own = np.random.default_rng(seed)
        points, across = at.points, at.x
        down = np.where(at.on_arm, ARM_LENGTH_M * at.along_arm, at.y)
        colours = np.repeat(first[None], len(across), axis=0)
        match pattern:
            case "across":
                colours[_wave(down, repeat_m) > duty] = second
            case "down":
                colours[_wave(across, 0.6 * repeat_m) > duty] = second
            case "plaid":
                bands = (_wave(down, check_m) > duty).astype(float) + (
                    _wave(across, check_m) > duty
                )
                colours += 0.5 * bands[:, None] * (second - first)
                lines = [_wave(each + 0.2 * check_m, check_m) > 0.93 for each in (down, across)]
                colours[lines[0] | lines[1]] = third
            case "camouflage":
                colours[noise(own, points, 1.3 * check_m) > duty] = second
                colours[noise(own, points, check_m) > 0.9] = third
            case "print":
                there = (np.abs(across - middle) < half_x) & (np.abs(down - height) < half_y)
                there &= (at.z > 0.0) & ~at.on_arm
                figure = noise(own, points, 0.03)
                colours[there & (figure > -0.2)] = second
                colours[there & (figure > 0.5)] = third
            case "washed":
                faded = 0.35 * noise(own, points, 0.12) + 0.2 * noise(own, points, 0.01)
                colours *= np.exp(faded)[:, None]
            case "flecks":
                colours *= np.exp(0.5 * noise(own, points, 0.008))[:, None]
            case _:
                pass
        return colours * np.exp(0.04 * noise(own, points, 0.02, octaves=1))[:, None]

    return paint


def _wave(along: Float[np.ndarray, " k"], repeat_m: float) -> Float[np.ndarray, " k"]:
    return np.sin(2.0 * np.pi * along / repeat_m)
