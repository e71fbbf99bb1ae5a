"""Random poses that the joint limits admit: what people can do, for figures on posed bodies."""

from collections.abc import Iterator

import numpy as np

from fitter.arrays import Pose
from fitter.body.joint_limits import LIMIT_SOFTNESS_DEG
from fitter.body.model import BodyModel
from fitter.body.pose_prior import PosePrior, pose_prior, prior_residuals
from fitter.body.skeleton import regress
from fitter.training.articulation.random_poses import random_pose

ADMITTED_DEGREES = LIMIT_SOFTNESS_DEG
"""How far the worst joint may be beyond its limits."""


def model_pose_prior(model: BodyModel) -> PosePrior:
    """The ranges of motion in the rest pose of a model's mean body."""
    joints = regress(model.joint_regressor, model.mean_vertices)
    return pose_prior(model.part_names, model.part_parent, joints)


def excess_degrees(prior: PosePrior, pose: Pose) -> float:
    """How far a pose leaves the limits at its worst joint and direction, degrees."""
    return float(LIMIT_SOFTNESS_DEG * np.abs(prior_residuals(prior, pose)[:, 3:]).max())


def plausible_poses(prior: PosePrior, rng: np.random.Generator) -> Iterator[Pose]:
    """Random poses within the limits, without end."""
    while True:
        pose = random_pose(rng)
        if excess_degrees(prior, pose) <= ADMITTED_DEGREES:
            yield pose
