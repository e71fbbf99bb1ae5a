"""Smooth random fields for textures, from a generator."""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import map_coordinates

LATTICE = 32


def value_noise(
    rng: np.random.Generator, points: Float[np.ndarray, "k d"], *, octaves: int = 3
) -> Float[np.ndarray, " k"]:
    """Periodic noise of mean 0 and standard deviation about 1 at points of a unit lattice.

    Each octave has twice the frequency and half the height of the one before.
    """
    dimension = points.shape[1]
    total = np.zeros(len(points))
    for octave in range(octaves):
        lattice = rng.normal(size=(LATTICE,) * dimension)
        places = (points * 2.0**octave).T
        total += 0.5**octave * map_coordinates(lattice, places, order=3, mode="grid-wrap")
    return total / total.std()
