"""The limb most parallel to the image plane, which gives the root's depth (section 3.1).

A limb of length L at depth z, slanted by an angle a to the image plane, spans about f L cos(a) / z
pixels. So f L / (image length) = z / cos(a) is at least the depth: every limb gives an upper
bound, and the smallest bound is the tightest, reached when its limb is parallel. The paper says
that the chosen limb *minimises* the ratio between its image length and its actual length; that
limb would be the most foreshortened one and its bound the loosest. We assume that the opposite was
meant: the limb that **maximises image length / actual length**.

Taking a maximum over noisy ratios favours whichever limb has an error upwards, short limbs most.
Each ratio is therefore lowered by its own uncertainty before they are compared.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.observation.click_spread import DEFAULT_SPREAD_M
from fitter.pose_init.limbs import LIMBS, Limb

LIMB_LENGTH_SPREAD = 0.04
"""Relative standard deviation of a limb's length among people of one gender and height."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceLimb:
    """The chosen limb and its image length over its actual length, pixels per metre."""

    limb: Limb
    scale: float


def reference_limb(
    ends: Mapping[str, Float[np.ndarray, "2"]],
    lengths_m: Mapping[str, float],
    *,
    candidates: Sequence[str],
) -> ReferenceLimb:
    """Pick the limb most parallel to the image plane.

    Parameters
    ----------
    ends
        Pixels of limb ends by point name.
    lengths_m
        Limb lengths by limb name.
    candidates
        Names of limbs with both ends seen; at least one.
    """
    best: ReferenceLimb | None = None
    best_bound = -np.inf
    for limb in LIMBS:
        if limb.name not in candidates:
            continue
        length = lengths_m[limb.name]
        scale = float(np.linalg.norm(ends[limb.distal] - ends[limb.proximal])) / length
        spread = np.hypot(LIMB_LENGTH_SPREAD, np.sqrt(2.0) * DEFAULT_SPREAD_M / length)
        bound = scale * (1.0 - spread)
        if bound > best_bound:
            best, best_bound = ReferenceLimb(limb=limb, scale=scale), bound
    if best is None:
        message = "reference_limb needs at least one candidate"
        raise ValueError(message)
    return best
