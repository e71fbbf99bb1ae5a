"""The held-out figures of a trained model, and how its header keeps them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fitter.body.model import BodyModel
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.report.evaluation import (
    VertexError,
    height_axes,
    joint_distances,
    posed_error,
    shape_error,
    shaped_and_posed_error,
    without_pose_term,
)

POSED_EXAMPLES = 200
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
