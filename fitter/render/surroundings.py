"""Light from all round as second-order spherical harmonics, beside the one light of Eq. 1.

A matt surface sees the surroundings through a clamped cosine, which lets pass only what is smooth:
nine coefficients carry 99 % of its energy (Ramamoorthi and Hanrahan, "An efficient representation
for irradiance environment maps", 2001). In units in which the light of Eq. 1 is 1 at the body's
centre,

    E(n) = 1/π ∫ L(w) (n.w)_+ dw = Σ_k e_k Y_k(n),    e_lm = A_l/π L_lm,  A_l/π = 1, 2/3, 1/4

with L the radiance from direction w and Y the real orthonormal harmonics in the order (l, m) =
(0, 0), (1, -1), (1, 0), (1, 1), (2, -2) ... (2, 2). A surface of albedo a shows a E(n) of it.
"""

import numpy as np
from jaxtyping import Float

from fitter.parameters import Surroundings

COUNT = 9

BAND_TRANSFER = (1.0, 2.0 / 3.0, 1.0 / 4.0)
"""A_l / π of bands 0, 1, 2: what the clamped cosine lets pass."""

BAND_OF = np.array([0, 1, 1, 1, 2, 2, 2, 2, 2])

_Y0 = 0.5 * np.sqrt(1.0 / np.pi)
_Y1 = np.sqrt(3.0 / (4.0 * np.pi))
_Y2 = 0.5 * np.sqrt(15.0 / np.pi)
_Y20 = 0.25 * np.sqrt(5.0 / np.pi)

_LEAST_SLOPE = 1e-12
_HALVINGS = 50

GLTF_SIGNS = np.array([1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0])
"""Of the coefficients when axes are turned by diag(1, -1, -1), from the camera's to glTF's."""


def harmonics(normals: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "k 9"]:
    """Y at unit vectors."""
    x, y, z = np.asarray(normals, dtype=np.float64).T
    return np.stack(
        [
            np.full_like(x, _Y0),
            _Y1 * y,
            _Y1 * z,
            _Y1 * x,
            _Y2 * x * y,
            _Y2 * y * z,
            _Y20 * (3.0 * z * z - 1.0),
            _Y2 * x * z,
            0.5 * _Y2 * (x * x - y * y),
        ],
        axis=1,
    )


def irradiance(
    surroundings: Surroundings, normals: Float[np.ndarray, "k 3"]
) -> Float[np.ndarray, " k"]:
    """E at unit normals, camera frame."""
    return harmonics(normals) @ surroundings


def irradiance_by_normal(
    surroundings: Surroundings, normals: Float[np.ndarray, "k 3"]
) -> Float[np.ndarray, "k 3"]:
    """dE/dn of the polynomial E, the normal a free vector."""
    x, y, z = np.asarray(normals, dtype=np.float64).T
    _, e1, e2, e3, e4, e5, e6, e7, e8 = surroundings
    return np.stack(
        [
            _Y1 * e3 + _Y2 * (e4 * y + e7 * z + e8 * x),
            _Y1 * e1 + _Y2 * (e4 * x + e5 * z - e8 * y),
            _Y1 * e2 + _Y2 * (e5 * y + e7 * x) + 6.0 * _Y20 * e6 * z,
        ],
        axis=1,
    )


def uniform_surroundings(level: float) -> Surroundings:
    """The same light from everywhere: E(n) is ``level`` for every n."""
    return np.concatenate([[level / _Y0], np.zeros(COUNT - 1)])


def mean_irradiance(surroundings: Surroundings) -> float:
    """E over all directions."""
    return float(_Y0 * surroundings[0])


def without_negative_light(surroundings: Surroundings, *, least: float) -> Surroundings:
    """The same with E nowhere below zero and no less than ``least`` on the mean.

    What differs from direction to direction is made as much smaller as it takes.
    """
    level = max(mean_irradiance(surroundings), least)
    bands = np.array(surroundings, dtype=np.float64)
    bands[0] = 0.0
    depth = -_lowest(bands)
    if depth > level:
        bands *= level / depth
    bands[0] = level / _Y0
    return bands


def _lowest(surroundings: Surroundings) -> float:
    """The least of E over the unit sphere.

    E is a quadratic form n.Qn + g.n + c there, whose minimum has (Q - μ) n = -g / 2 with the
    multiplier μ below every eigenvalue of Q and |n| = 1.
    """
    e0, e1, e2, e3, e4, e5, e6, e7, e8 = surroundings
    linear = _Y1 * np.array([e3, e1, e2])
    across = 0.5 * _Y2 * np.array([[e8, e4, e7], [e4, -e8, e5], [e7, e5, 0.0]])
    across[2, 2] = 3.0 * _Y20 * e6
    constant = _Y0 * e0 - _Y20 * e6
    eigenvalues, axes = np.linalg.eigh(across)
    slopes = axes.T @ linear
    if np.linalg.norm(slopes) < _LEAST_SLOPE:
        return float(constant + eigenvalues[0])
    # A slope of zero along the first axis would hide the multiplier.
    slopes[0] = max(abs(slopes[0]), _LEAST_SLOPE)
    # |n| grows with μ, and is 1 between these two.
    low = eigenvalues[0] - 0.5 * np.linalg.norm(slopes)
    high = eigenvalues[0] - 0.5 * slopes[0]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        longer = np.linalg.norm(slopes / (2.0 * (eigenvalues - middle))) > 1.0
        low, high = (low, middle) if longer else (middle, high)
    direction = -slopes / (2.0 * (eigenvalues - low))
    return float(constant + low + 0.5 * slopes @ direction)
