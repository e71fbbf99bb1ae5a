"""The held-out figures of a trained model, as numbers for its header and as a table to read."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fitter.body.model import BodyModel
from fitter.training.assemble import RegisteredBodies
from fitter.training.evaluation import (
    VertexError,
    evaluation_milliseconds,
    height_axes,
    joint_distances,
    posed_error,
    shape_error,
    shaped_and_posed_error,
    without_pose_term,
)

POSED_EXAMPLES = 200
TIMED_EVALUATIONS = 500
_SEED = 20090929
"""Of the held-out poses; training draws its own from the build's seed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldOutErrors:
    """Figures on subjects, and poses, that the model has not seen; millimetres."""

    subjects: int
    shape: VertexError
    height_change_at_3_deviations: float
    extent_change_at_3_deviations: float
    height_per_deviation: float
    height_correlation: float
    posed: VertexError
    posed_rigid_parts_only: VertexError
    shaped_and_posed: VertexError
    joints: Mapping[str, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A figure with what it must not exceed."""

    name: str
    value: float
    unit: str
    limit: float


def held_out_errors(model: BodyModel, bodies: RegisteredBodies) -> HeldOutErrors:
    """All held-out figures of a model; the same every time."""
    height = height_axes(model, bodies)

    def poses() -> np.random.Generator:
        return np.random.default_rng(_SEED)

    return HeldOutErrors(
        subjects=len(bodies.rest),
        shape=shape_error(model, bodies.rest),
        height_change_at_3_deviations=float(height.changes_mm.max()),
        extent_change_at_3_deviations=float(height.extent_changes_mm.max()),
        height_per_deviation=height.per_deviation_mm,
        height_correlation=height.correlation,
        posed=posed_error(model, bodies, POSED_EXAMPLES, poses()),
        posed_rigid_parts_only=posed_error(
            without_pose_term(model), bodies, POSED_EXAMPLES, poses()
        ),
        shaped_and_posed=shaped_and_posed_error(model, bodies, POSED_EXAMPLES, poses()),
        joints=joint_distances(model, bodies),
    )


def header_entry(errors: HeldOutErrors) -> dict[str, float | int]:
    """The figures as the model file's header keeps them."""
    return {
        "subjects": errors.subjects,
        "shape_mm": errors.shape.by_vertex,
        "shape_by_area_mm": errors.shape.by_area,
        "height_change_at_3_deviations_mm": errors.height_change_at_3_deviations,
        "extent_change_at_3_deviations_mm": errors.extent_change_at_3_deviations,
        "height_per_deviation_mm": errors.height_per_deviation,
        "height_correlation": errors.height_correlation,
        "posed_mm": errors.posed.by_vertex,
        "posed_by_area_mm": errors.posed.by_area,
        "posed_rigid_parts_only_mm": errors.posed_rigid_parts_only.by_vertex,
        "shaped_and_posed_mm": errors.shaped_and_posed.by_vertex,
        "joints_mm": float(np.mean(list(errors.joints.values()))),
        "worst_joint_mm": max(errors.joints.values()),
    }


def goals(model: BodyModel, errors: HeldOutErrors) -> tuple[Goal, ...]:
    """The figures that a model must reach, the time of one evaluation measured now."""
    milliseconds = evaluation_milliseconds(model, TIMED_EVALUATIONS, np.random.default_rng(_SEED))
    count = len(model.shape_basis)
    return (
        Goal(
            name=f"mean vertex error, n = {count}",
            value=errors.shape.by_vertex,
            unit="mm",
            limit=3.5,
        ),
        Goal(
            name="height change, other axes, 3 sd",
            value=errors.height_change_at_3_deviations,
            unit="mm",
            limit=3.0,
        ),
        Goal(
            name="  the same of the mesh's full extent",
            value=errors.extent_change_at_3_deviations,
            unit="mm",
            limit=3.0,
        ),
        Goal(
            name="posed error with the pose term",
            value=errors.posed.by_vertex,
            unit="mm",
            limit=6.0,
        ),
        Goal(name="one evaluation", value=milliseconds, unit="ms", limit=2.0),
    )


def report_lines(model: BodyModel, errors: HeldOutErrors, *, file_bytes: int) -> tuple[str, ...]:
    """The report of one gender, line by line."""
    header = model.header
    size = f"{len(model.mean_vertices)} vertices, {len(model.triangles)} triangles"
    subjects = f"{header.get('training_subjects')} subjects, held out {errors.subjects}"
    lines = [
        f"{model.gender}: {size}, {len(model.shape_basis)} shape axes, {file_bytes / 1e6:.1f} MB",
        f"  trained on {subjects}, seed {header['seed']}",
    ]
    for goal in goals(model, errors):
        verdict = "ok" if goal.value <= goal.limit else "MISSED"
        lines.append(
            f"  {goal.name:<38}{goal.value:9.3f} {goal.unit}   goal <= {goal.limit:g}  {verdict}"
        )
    plain = {
        "mean error by area instead": f"{errors.shape.by_area:9.3f} mm",
        "posed error by area instead": f"{errors.posed.by_area:9.3f} mm",
        "posed error, rigid parts only": f"{errors.posed_rigid_parts_only.by_vertex:9.3f} mm",
        "posed error of bodies rebuilt from n": f"{errors.shaped_and_posed.by_vertex:9.3f} mm",
        "height gained per sd of its axis": f"{errors.height_per_deviation:9.3f} mm",
        "correlation of height with its axis": f"{errors.height_correlation:11.5f}",
    }
    worst = max(errors.joints, key=lambda name: errors.joints[name])
    plain |= {
        "joint centres, mean distance": f"{np.mean(list(errors.joints.values())):9.3f} mm",
        f"joint centres, worst: {worst}": f"{errors.joints[worst]:9.3f} mm",
    }
    lines.extend(f"  {name:<38}{value}" for name, value in plain.items())
    earlier = header.get("height_in_earlier_methods")
    if isinstance(earlier, Mapping):
        lines.append("  earlier methods on the same bodies (section 4)")
        lines.extend(f"    {name:<36}{float(value):9.3f}" for name, value in earlier.items())
    residuals = header.get("population_residuals")
    if isinstance(residuals, Mapping):
        lines.append("  population: mean absolute distance of a subject from its measurements")
        lines.extend(f"    {name:<36}{value}" for name, value in residuals.items())
    return tuple(lines)
