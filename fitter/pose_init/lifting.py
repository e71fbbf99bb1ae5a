"""What a camera model must provide to lift clicked limbs into three dimensions.

There are two: :mod:`fitter.pose_init.perspective` (Lee and Chen, the paper's choice) and
:mod:`fitter.pose_init.orthographic` (Taylor, the paper's comparison). The code that traverses the
body (:mod:`fitter.pose_init.trunk`, :mod:`fitter.pose_init.hypotheses`) knows only this protocol.
"""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

NEAR, FAR = 0, 1
"""The two solutions for the far end of a limb: nearer to the camera, or farther."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LimbEnds:
    """Both possible positions of the other end of a limb.

    Attributes
    ----------
    points
        (..., 2, 3) camera frame, metres; the nearer one first.
    overreach_m
        (...) how much too long the limb appears: distance from the known end to the returned
        point minus the limb's length, if no point of the ray is within reach; else 0.
    """

    points: Float[np.ndarray, "... 2 3"]
    overreach_m: Float[np.ndarray, "..."]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CrossPieceEnds:
    """Both ways a rigid width can lie when the depth of its middle is known.

    Attributes
    ----------
    first, second
        (..., 2, 3) camera frame, metres; the solution with the second end nearer comes first.
    overreach_m
        As for :class:`LimbEnds`.
    """

    first: Float[np.ndarray, "... 2 3"]
    second: Float[np.ndarray, "... 2 3"]
    overreach_m: Float[np.ndarray, "..."]


@runtime_checkable
class Lifting(Protocol):
    """A camera model's three constructions; pixels are (2,), lengths metres."""

    def place(
        self, pixel: Float[np.ndarray, "2"], depth: Float[np.ndarray, "..."]
    ) -> Float[np.ndarray, "... 3"]:
        """The point of the pixel's ray at this depth (camera-frame z)."""
        ...

    def parallel_depth(
        self, first: Float[np.ndarray, "2"], second: Float[np.ndarray, "2"], length_m: float
    ) -> float:
        """Depth at which a limb of this length, parallel to the image, spans the two pixels."""
        ...

    def reach(
        self, known: Float[np.ndarray, "... 3"], pixel: Float[np.ndarray, "2"], length_m: float
    ) -> LimbEnds:
        """The points of the pixel's ray at the limb's length from its known end."""
        ...

    def spread(
        self,
        middle_depth: Float[np.ndarray, "..."],
        first: Float[np.ndarray, "2"],
        second: Float[np.ndarray, "2"],
        width_m: float,
    ) -> CrossPieceEnds:
        """The ends of a rigid width on two rays, its middle at this depth."""
        ...
