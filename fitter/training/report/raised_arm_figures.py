"""How well shoulders bend: posed error by where the arms reach."""

from dataclasses import dataclass
from itertools import islice

import numpy as np
from jaxtyping import Bool

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.parameters import BodyParameters
from fitter.training.articulation.arm_reaches import ARM_REACHES, ArmReach, with_arms_reaching
from fitter.training.articulation.plausible_poses import model_pose_prior, plausible_poses
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.report.evaluation import bodies_as_axes
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines

POSES = 60
"""Of each reach; the rest of the body in plausible poses, one for each held-out body in turn."""

SHOULDER_PARTS = ("chest", "neck", "left_upper_arm", "right_upper_arm")

GOAL_MM = 5.0
"""For the shoulders' skin, with the arms above them."""

_ABOVE_DEGREES = 90.0
_SEED = 20090931


@dataclass(frozen=True, slots=True, kw_only=True)
class ReachError:
    """Distance of vertices from the rig's, each body's shape given exactly, millimetres.

    ``shoulders`` is the mean over chest, neck and upper arms, ``shoulders_95th`` the 95th
    percentile of the same over poses and vertices, ``everywhere`` the mean over all vertices.
    """

    shoulders: float
    shoulders_95th: float
    everywhere: float


def shoulder_vertices(model: BodyModel) -> Bool[np.ndarray, " m"]:
    """The vertices of chest, neck and upper arms: those that follow one of them most."""
    parts = [model.part_names.index(name) for name in SHOULDER_PARTS]
    return np.isin(model.skinning_parts[:, 0], parts)


def reach_error(
    model: BodyModel,
    bodies: RegisteredBodies,
    reach: ArmReach,
    count: int,
    rng: np.random.Generator,
) -> ReachError:
    """Error of held-out bodies whose arms reach so, after the best translation."""
    evaluator = ScapeEvaluator(bodies_as_axes(model, bodies.rest))
    shapes = np.eye(len(bodies.rest))
    distances = np.empty((count, len(model.mean_vertices)))
    for k, calm in enumerate(islice(plausible_poses(model_pose_prior(model), rng), count)):
        subject = k % len(shapes)
        pose = with_arms_reaching(calm, reach, rng)
        found = evaluator.body_frame_vertices(
            BodyParameters(pose=pose, translation=np.zeros(3), shape=shapes[subject])
        )
        residuals = found - bodies.posed(subject, pose)
        distances[k] = 1000.0 * np.linalg.norm(residuals - residuals.mean(axis=0), axis=1)
    about = distances[:, shoulder_vertices(model)]
    return ReachError(
        shoulders=float(about.mean()),
        shoulders_95th=float(np.percentile(about, 95.0)),
        everywhere=float(distances.mean()),
    )


def raised_arm_lines(reported: Reported) -> tuple[str, ...]:
    """The section of the report."""
    errors = {
        name: reach_error(
            reported.model, reported.bodies, reach, POSES, np.random.default_rng(_SEED)
        )
        for name, reach in ARM_REACHES.items()
    }
    rows = [
        (
            name,
            f"{error.shoulders:.2f}",
            f"{error.shoulders_95th:.2f}",
            f"{error.everywhere:.2f}",
        )
        for name, error in errors.items()
    ]
    raised = [
        errors[name].shoulders
        for name, reach in ARM_REACHES.items()
        if reach.elevation[0] >= _ABOVE_DEGREES
    ]
    return (
        *table_lines(
            f"posed error by where the arms reach, {POSES} held-out bodies each, mm",
            ("angle between upper arm and straight down", "shoulders", "95th", "everywhere"),
            rows,
        ),
        *note_lines(
            "Shoulders: chest, neck and upper arms, mean and 95th percentile. Goal: "
            f"{GOAL_MM:g} mm on average with arms above the shoulders: "
            f"{'ok' if max(raised) <= GOAL_MM else 'MISSED'}."
        ),
    )
