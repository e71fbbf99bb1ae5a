"""Bodies on one mesh, at rest and in any pose: what a model is learned from."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RegisteredBodies:
    """Bodies on one mesh, at rest in one pose, body frame, metres.

    Attributes
    ----------
    rest
        (s, m, 3).
    joints
        (s, p, 3) true centres about which the parts turn.
    posed
        Body of an index in a pose: a rig's answer here, registered scans for those who have them.
    measurements
        (s, k) in any units, that the shape space shall keep beside the vertices; None to keep
        vertices alone.
    """

    rest: Float[np.ndarray, "s m 3"]
    joints: Float[np.ndarray, "s p 3"]
    posed: Callable[[int, Pose], Vertices]
    measurements: Float[np.ndarray, "s k"] | None = None
