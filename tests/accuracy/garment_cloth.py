"""A garment's colours: plain weave, stripes or checks."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from tests.accuracy.noise import smooth_step, value_noise
from tests.accuracy.scene import Cloth, Pattern

REPEAT_M = 0.07
"""Distance from one stripe to the next."""

WEAVE = 0.06


def cloth_albedo(
    cloth: Cloth, points: Vertices, rng: np.random.Generator
) -> Float[np.ndarray, "k 3"]:
    """Linear albedo at points of the cloth, world."""
    first, second = np.array(cloth.colour), np.array(cloth.second_colour)
    weave = 1.0 + WEAVE * value_noise(rng, points / 0.02)
    wavering = points + 0.004 * value_noise(rng, points / 0.2)[:, None]
    share = np.zeros(len(points))
    if cloth.pattern is not Pattern.PLAIN:
        share = _band(wavering[:, 1])
    if cloth.pattern is Pattern.CHECKS:
        share = 0.5 * (share + _band(wavering[:, 0]))
    albedo = first + share[:, None] * (second - first)
    return np.clip(albedo * weave[:, None], 0.003, 0.9)


def _band(along: Float[np.ndarray, " k"]) -> Float[np.ndarray, " k"]:
    return smooth_step(np.sin(2.0 * np.pi * along / REPEAT_M), -0.15, 0.15)
