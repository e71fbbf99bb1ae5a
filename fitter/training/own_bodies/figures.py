"""Held-out figures of a model trained on a user's own bodies."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.parameters import BodyParameters
from fitter.training.assemble import height_attribute
from fitter.training.own_bodies.folder import PosedScan
from fitter.training.report.evaluation import (
    CHECKED_AT_DEVIATIONS,
    VertexError,
    bodies_as_axes,
    mean_areas,
    shape_error,
    vertex_error,
    without_pose_term,
)
from fitter.training.shapes.height_rotation import attribute_changes


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnErrors:
    """Figures on the subjects that were held out; millimetres.

    ``posed`` and ``posed_rigid_parts_only`` are of ``scans`` in poses, with each body's shape given
    exactly; None where no held-out subject has any.
    """

    subjects: int
    shape: VertexError
    height_change_at_3_deviations: float
    height_per_deviation: float
    scans: int
    posed: VertexError | None
    posed_rigid_parts_only: VertexError | None


def own_errors(
    model: BodyModel,
    rest: Float[np.ndarray, "s m 3"],
    held_out: Integer[np.ndarray, " h"],
    posed: Sequence[PosedScan],
) -> OwnErrors:
    """All held-out figures; ``rest`` and ``posed`` are of all subjects."""
    height = height_attribute(model)
    axes = np.eye(len(model.shape_basis))
    changes = attribute_changes(height, list(axes[1:]), CHECKED_AT_DEVIATIONS)
    scans = [scan for scan in posed if scan.subject in held_out]
    return OwnErrors(
        subjects=len(held_out),
        shape=shape_error(model, rest[held_out]),
        height_change_at_3_deviations=1000.0 * float(changes.max()),
        height_per_deviation=500.0 * (height(axes[0]) - height(-axes[0])),
        scans=len(scans),
        posed=_posed_error(model, rest, scans),
        posed_rigid_parts_only=_posed_error(without_pose_term(model), rest, scans),
    )


def header_entry(errors: OwnErrors) -> dict[str, float | int]:
    """The figures as the model file's header keeps them."""
    entry: dict[str, float | int] = {
        "subjects": errors.subjects,
        "shape_mm": errors.shape.by_vertex,
        "shape_by_area_mm": errors.shape.by_area,
        "height_change_at_3_deviations_mm": errors.height_change_at_3_deviations,
        "height_per_deviation_mm": errors.height_per_deviation,
        "scans": errors.scans,
    }
    if errors.posed is not None and errors.posed_rigid_parts_only is not None:
        entry |= {
            "posed_mm": errors.posed.by_vertex,
            "posed_by_area_mm": errors.posed.by_area,
            "posed_rigid_parts_only_mm": errors.posed_rigid_parts_only.by_vertex,
        }
    return entry


def own_report_lines(model: BodyModel, errors: OwnErrors, *, file_bytes: int) -> tuple[str, ...]:
    """The report, line by line."""
    header = model.header
    figures = [
        (f"mean vertex error, n = {len(model.shape_basis)}", errors.shape.by_vertex),
        ("mean error by area instead", errors.shape.by_area),
        ("height change, other axes, 3 sd", errors.height_change_at_3_deviations),
        ("height gained per sd of its axis", errors.height_per_deviation),
    ]
    if errors.posed is not None and errors.posed_rigid_parts_only is not None:
        figures += [
            (f"posed error, {errors.scans} scans", errors.posed.by_vertex),
            ("posed error, rigid parts only", errors.posed_rigid_parts_only.by_vertex),
        ]
    size = f"{len(model.mean_vertices)} vertices, {len(model.triangles)} triangles"
    subjects = f"{header['training_subjects']} subjects, held out {errors.subjects}"
    return (
        f"{model.gender}: {size}, {len(model.shape_basis)} shape axes, {file_bytes / 1e6:.1f} MB",
        f"  trained on {subjects}, seed {header['seed']}",
        f"  pose-dependent term: {header['pose_term']}",
        *(f"  {name:<38}{value:9.3f} mm" for name, value in figures),
    )


def _posed_error(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"], scans: Sequence[PosedScan]
) -> VertexError | None:
    """Error of held-out scans, each body's shape given exactly, whole-body translation free."""
    if not scans:
        return None
    subjects = sorted({scan.subject for scan in scans})
    evaluator = ScapeEvaluator(bodies_as_axes(model, rest[subjects]))
    residuals = []
    for scan in scans:
        assert scan.pose is not None
        shape = np.eye(len(subjects))[subjects.index(scan.subject)]
        found = evaluator.body_frame_vertices(
            BodyParameters(pose=scan.pose, translation=np.zeros(3), shape=shape)
        )
        residuals.append(found - scan.vertices)
    return vertex_error(np.stack(residuals), mean_areas(model))
