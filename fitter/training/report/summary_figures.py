"""The head of the report: what the model is, and whether it reaches its goals."""

from dataclasses import dataclass

import numpy as np

from fitter.training.report.evaluation import evaluation_milliseconds
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import table_lines

TIMED_EVALUATIONS = 500
_SEED = 20090929


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A figure with what it must not exceed."""

    name: str
    value: float
    unit: str
    limit: float

    @property
    def verdict(self) -> str:
        """``ok`` or ``MISSED``."""
        return "ok" if self.value <= self.limit else "MISSED"


def goals(reported: Reported) -> tuple[Goal, ...]:
    """The figures that a model must reach, the time of one evaluation measured now."""
    model, errors = reported.model, reported.errors
    milliseconds = evaluation_milliseconds(model, TIMED_EVALUATIONS, np.random.default_rng(_SEED))
    millimetres = (
        (f"mean vertex error, n = {len(model.shape_basis)}", errors.shape.by_vertex, 3.0),
        ("height change, other axes, 3 sd", errors.height_change_at_3_deviations, 1.0),
        ("posed error with the pose term", errors.posed.by_vertex, 4.5),
    )
    return (
        *(
            Goal(name=name, value=value, unit="mm", limit=limit)
            for name, value, limit in millimetres
        ),
        Goal(name="one evaluation", value=milliseconds, unit="ms", limit=2.0),
    )


def summary_lines(reported: Reported) -> tuple[str, ...]:
    """Size, provenance, goals, and the figures beside them."""
    model, errors = reported.model, reported.errors
    mesh = f"{len(model.mean_vertices)} vertices, {len(model.triangles)} triangles"
    size = f"{mesh}, {len(model.shape_basis)} shape axes, {reported.file_bytes / 1e6:.1f} MB"
    subjects = f"{model.header.get('training_subjects')} subjects, held out {errors.subjects}"
    judged = [
        (goal.name, f"{goal.value:.3f} {goal.unit}", f"<= {goal.limit:g}", goal.verdict)
        for goal in goals(reported)
    ]
    worst = max(errors.joints, key=lambda name: errors.joints[name])
    beside = [
        ("mean error by area instead", f"{errors.shape.by_area:.3f} mm"),
        ("posed error by area instead", f"{errors.posed.by_area:.3f} mm"),
        ("posed error, rigid parts only", f"{errors.posed_rigid_parts_only.by_vertex:.3f} mm"),
        ("posed error of bodies rebuilt from n", f"{errors.shaped_and_posed.by_vertex:.3f} mm"),
        (
            "full extent's change, other axes, 3 sd",
            f"{errors.extent_change_at_3_deviations:.3f} mm",
        ),
        ("height gained per sd of its axis", f"{errors.height_per_deviation:.3f} mm"),
        ("correlation of height with its axis", f"{errors.height_correlation:.5f}"),
        ("joint centres, mean distance", f"{np.mean(list(errors.joints.values())):.3f} mm"),
        (f"joint centres, worst: {worst}", f"{errors.joints[worst]:.3f} mm"),
    ]
    return (
        f"{model.gender}: {size}",
        f"  trained on {subjects}, seed {model.header['seed']}",
        *table_lines("goals, on held-out subjects", ("", "found", "goal", ""), judged),
        *table_lines("beside them", ("", ""), beside),
    )
