"""From closed-form starts to a few distinct, refined hypotheses."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.pose_init.click_fit import FittedPoses, fit_clicks
from fitter.pose_init.click_problem import ClickProblem
from fitter.pose_init.head import turn_head
from fitter.pose_init.landmark_rig import LandmarkRig, landmark_points
from fitter.pose_init.lifting import Lifting
from fitter.pose_init.limbs import LIMBS, limb_slant
from fitter.pose_init.reference_limb import ReferenceLimb
from fitter.pose_init.start_poses import start_poses
from fitter.vocabulary.choices import Facing

STARTS = 16
"""At most this many closed-form readings are refined."""

MOST_HYPOTHESES = 8
"""At most this many hypotheses are refined fully and returned."""

_ROUGH_ITERATIONS, _FINE_ITERATIONS = 5, 20

HOPELESS_ENERGY = 25.0
"""Hypotheses this much above the best are dropped: a likelihood of e to the -25 is no alternative,
and a limb bent far beyond its limits would only cost time until the picture's evidence rejects it.
"""

_SAME_BASIN = np.radians(12.0)
"""Roughly refined poses whose joints all agree this closely would converge to the same pose."""

_CLEAR_SLANT = 0.15
"""Difference of two slants that matters, as a share of the limb's length (about 9 degrees)."""

_SAME_POSE = np.radians(6.0)
"""Refined poses whose joints all agree this closely are one hypothesis."""


def refined_hypotheses(
    problem: ClickProblem,
    lifting: Lifting,
    *,
    pixels: Mapping[str, Float[np.ndarray, "2"]],
    lengths_m: Mapping[str, float],
    reference: ReferenceLimb,
    limb_facing: Mapping[str, Facing],
) -> FittedPoses:
    """Closed-form starts, head, and refinement on blended landmarks; best first."""
    starts = start_poses(
        problem.rig,
        problem.prior,
        lifting,
        pixels,
        lengths_m,
        reference.limb,
        limb_facing=limb_facing,
        count=STARTS,
    )
    pose = turn_head(problem, starts.pose, starts.translation)
    rough = fit_clicks(problem, pose, starts.translation, iterations=_ROUGH_ITERATIONS).ranked()
    kept = _distinct(rough, _SAME_BASIN, most=MOST_HYPOTHESES)
    fine = fit_clicks(problem, kept.pose, kept.translation, iterations=_FINE_ITERATIONS)
    return distinct_hypotheses(fine)


def distinct_hypotheses(fitted: FittedPoses) -> FittedPoses:
    """Best first, without poses that converged to a better one's or are hopelessly worse."""
    return _distinct(fitted.ranked(), _SAME_POSE, most=len(fitted.pose))


def limb_facings(rig: LandmarkRig, fitted: FittedPoses) -> list[dict[str, Facing]]:
    """Which way every limb of every pose faces.

    A limb nearly parallel to the image may come out a degree to either side in two poses that are
    really the same reading. So a pose differs from the first only in limbs whose slant clearly
    differs.
    """
    points = landmark_points(rig, fitted.pose, fitted.translation)
    result: list[dict[str, Facing]] = [{} for _ in points]
    for limb in LIMBS:
        row = limb_slant(limb, rig.landmark_names)
        length = float(np.linalg.norm(row @ rig.rest_landmarks))
        slants = points[..., 2] @ row
        clear = np.abs(slants - slants[0]) > _CLEAR_SLANT * length
        for facing, slant in zip(result, np.where(clear, slants, slants[0]), strict=True):
            facing[limb.name] = Facing.TOWARD if slant < 0.0 else Facing.AWAY
    return result


def _distinct(fitted: FittedPoses, angle: float, *, most: int) -> FittedPoses:
    kept: list[int] = []
    for row, pose in enumerate(fitted.pose):
        if len(kept) == most or fitted.energy[row] > fitted.energy[0] + HOPELESS_ENERGY:
            break
        if all(np.abs(pose - fitted.pose[other]).max() > angle for other in kept):
            kept.append(row)
    return fitted.chosen(np.array(kept))
