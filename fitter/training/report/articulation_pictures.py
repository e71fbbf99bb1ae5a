"""The sheet of extreme poses: what a fold, a dent or a collapsed joint would show in."""

import numpy as np

from fitter.arrays import Shape
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.skeleton import regress
from fitter.parameters import BodyParameters
from fitter.training.articulation.extreme_poses import extreme_poses
from fitter.training.report.body_sheets import (
    FRONT,
    SIDE,
    THREE_QUARTER,
    Levels,
    Panel,
    scale_for,
    sheet,
)
from fitter.training.shapes.attributes import measurement_attribute
from fitter.training.shapes.likely_bodies import weight_direction

HEAVY_DEVIATIONS = 2.0
"""How heavy the second body is, at the likeliest build of its weight."""

BACK_QUARTER = 180.0 + THREE_QUARTER
PX_PER_M = 220.0


def extreme_poses_sheet(evaluator: ScapeEvaluator) -> Levels:
    """Mean and heavy body in every extreme pose, from the front, the side, and two quarters.

    The left limb poses; what hides in front is seen from the back.
    """
    count = len(evaluator.model.shape_basis)
    weight = measurement_attribute(evaluator.model, "weight")
    heavy = HEAVY_DEVIATIONS * weight_direction(weight, count)
    bodies = {"mean": _in_poses(evaluator, np.zeros(count)), "heavy": _in_poses(evaluator, heavy)}
    groups = {
        f"{name}, {body}": in_poses[name]
        for name in bodies["mean"]
        for body, in_poses in bodies.items()
    }
    every = [panel.vertices for panels in groups.values() for panel in panels]
    scale = scale_for(every, px_per_m=PX_PER_M)
    return sheet(groups, evaluator.model.triangles, scale, groups_per_row=2)


def _in_poses(evaluator: ScapeEvaluator, shape: Shape) -> dict[str, list[Panel]]:
    model = evaluator.model
    joints = regress(model.joint_regressor, rest_vertices(model, shape))
    panels: dict[str, list[Panel]] = {}
    for name, pose in extreme_poses(joints).items():
        vertices = evaluator.body_frame_vertices(
            BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
        )
        panels[name] = [
            Panel(vertices=vertices, degrees=degrees, label="", lines_m=())
            for degrees in (FRONT, THREE_QUARTER, SIDE, BACK_QUARTER)
        ]
    return panels
