"""Pictures of a trained model: its shape space, after the paper's Fig. 6, and its extreme poses."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, rest_vertices, standing_vertices
from fitter.body.skeleton import regress
from fitter.export.display import png
from fitter.parameters import BodyParameters
from fitter.training.articulation.extreme_poses import extreme_poses
from fitter.training.report.body_sheets import (
    FRONT,
    SIDE,
    THREE_QUARTER,
    Levels,
    Panel,
    SheetScale,
    scale_for,
    sheet,
)
from fitter.training.shapes.attributes import measurement_attribute
from fitter.training.shapes.likely_bodies import body_of_weight, random_shapes, weight_direction

DEVIATIONS = 3.0
FIRST_AXES = 6
"""Height and the five largest other axes: a sheet that can be compared with the paper's figure."""

PERCENTILE = 1.645
"""Standard deviations of the 5th and the 95th percentile."""

RANDOM_BODIES = 20
_SEED = 20090929

LARGE_PX_PER_M = 280.0
SMALL_PX_PER_M = 165.0
EXTREME_POSES_PX_PER_M = 220.0

HEAVY_DEVIATIONS = 2.0
"""How heavy the second body is, at the likeliest build of its weight."""

BACK_QUARTER = 180.0 + THREE_QUARTER


def write_pictures(model: BodyModel, folder: Path) -> tuple[Path, ...]:
    """Write all sheets of a model as PNG files; the same model, the same bytes.

    Raises
    ------
    OSError
        If the folder cannot be made or written to.
    """
    folder.mkdir(parents=True, exist_ok=True)
    evaluator = ScapeEvaluator(model)
    written = []
    for name, drawn in _SHEETS.items():
        path = folder / f"{model.gender}_{name}.png"
        path.write_bytes(png(drawn(evaluator)))
        written.append(path)
    return tuple(written)


def first_axes_sheet(evaluator: ScapeEvaluator) -> Levels:
    """Bodies at -3, 0 and +3 standard deviations along height and the next axes, from the front."""
    mean_height = height_of_shape(evaluator, np.zeros(_count(evaluator)))
    bodies = {
        axis: [_along(evaluator, axis, at) for at in (-DEVIATIONS, 0.0, DEVIATIONS)]
        for axis in range(min(FIRST_AXES, _count(evaluator)))
    }
    groups = {
        _axis_title(axis): [
            Panel(
                vertices=standing,
                degrees=FRONT,
                label=f"{at:+.0f} sd  {100.0 * height_of_shape(evaluator, shape):.1f} cm",
                lines_m=(mean_height,),
            )
            for at, (shape, standing) in zip((-DEVIATIONS, 0.0, DEVIATIONS), found, strict=True)
        ]
        for axis, found in bodies.items()
    }
    scale = _scale(groups, LARGE_PX_PER_M)
    return sheet(groups, evaluator.model.triangles, scale, groups_per_row=3)


def all_axes_sheet(evaluator: ScapeEvaluator) -> Levels:
    """Both ends of every axis from the front and from the side."""
    mean_height = height_of_shape(evaluator, np.zeros(_count(evaluator)))
    groups = {}
    for axis in range(_count(evaluator)):
        ends = {at: _along(evaluator, axis, at) for at in (-DEVIATIONS, DEVIATIONS)}
        groups[_axis_title(axis)] = [
            Panel(vertices=standing, degrees=degrees, label=f"{at:+.0f} sd", lines_m=(mean_height,))
            for degrees in (FRONT, SIDE)
            for at, (_, standing) in ends.items()
        ]
    scale = _scale(groups, SMALL_PX_PER_M)
    return sheet(groups, evaluator.model.triangles, scale, groups_per_row=4)


def percentile_sheet(evaluator: ScapeEvaluator) -> Levels:
    """5th, 50th and 95th percentile: of height at the mean weight, of weight at the mean height."""
    count = _count(evaluator)
    weight = measurement_attribute(evaluator.model, "weight")
    direction = weight_direction(weight, count)
    mean_weight = weight(np.zeros(count))
    groups = {}
    for name, at in (("5th", -PERCENTILE), ("50th", 0.0), ("95th", PERCENTILE)):
        tall = at * np.eye(count)[0]
        shape = body_of_weight(weight, tall, direction, mean_weight)
        groups[f"height: {name} percentile"] = _three_views(evaluator, shape, weight(shape))
    for name, at in (("5th", -PERCENTILE), ("50th", 0.0), ("95th", PERCENTILE)):
        shape = at * direction
        groups[f"weight: {name} percentile"] = _three_views(evaluator, shape, weight(shape))
    scale = _scale(groups, LARGE_PX_PER_M)
    return sheet(groups, evaluator.model.triangles, scale, groups_per_row=3)


def random_sheet(evaluator: ScapeEvaluator) -> Levels:
    """Bodies drawn from the prior, from three sides."""
    weight = measurement_attribute(evaluator.model, "weight")
    drawn = random_shapes(RANDOM_BODIES, _count(evaluator), np.random.default_rng(_SEED))
    groups = {
        f"body {number}": _three_views(evaluator, shape, weight(shape))
        for number, shape in enumerate(drawn, start=1)
    }
    scale = _scale(groups, SMALL_PX_PER_M)
    return sheet(groups, evaluator.model.triangles, scale, groups_per_row=4)


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
    scale = scale_for(every, px_per_m=EXTREME_POSES_PX_PER_M)
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


_SHEETS: dict[str, Callable[[ScapeEvaluator], Levels]] = {
    "first_axes": first_axes_sheet,
    "all_axes": all_axes_sheet,
    "percentiles": percentile_sheet,
    "random_bodies": random_sheet,
    "extreme_poses": extreme_poses_sheet,
}


def _count(evaluator: ScapeEvaluator) -> int:
    return len(evaluator.model.shape_basis)


def _along(evaluator: ScapeEvaluator, axis: int, at: float) -> tuple[Shape, Vertices]:
    shape = at * np.eye(_count(evaluator))[axis]
    return shape, standing_vertices(evaluator, shape)


def _axis_title(axis: int) -> str:
    return "axis 1: height" if axis == 0 else f"axis {axis + 1}"


def _three_views(evaluator: ScapeEvaluator, shape: Shape, weight_kg: float) -> list[Panel]:
    height_m = height_of_shape(evaluator, shape)
    standing = standing_vertices(evaluator, shape)
    labels = (f"{100.0 * height_m:.0f} cm", f"{weight_kg:.0f} kg", "")
    return [
        Panel(vertices=standing, degrees=degrees, label=label, lines_m=(height_m,))
        for degrees, label in zip((FRONT, THREE_QUARTER, SIDE), labels, strict=True)
    ]


def _scale(groups: dict[str, list[Panel]], px_per_m: float) -> SheetScale:
    bodies = [panel.vertices for panels in groups.values() for panel in panels]
    return scale_for(bodies, px_per_m=px_per_m)
