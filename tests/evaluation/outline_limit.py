"""What outlines alone can say: how well they foretell measurements of people never seen.

Each held-out subject of the training's population stands at rest before a camera without
perspective. Widths of trunk and legs at many heights, exactly known, and the stature foretell every
measurement by ridge regression from the other subjects: from the front, from the side, from both.
No fit to an outline seen from the front can do better than the first on the mean, but for what is
not linear.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool, Float

from fitter.body.model import BodyModel
from fitter.measurement.definition_file import load_definitions
from fitter.training.articulation.rigged_bodies import rigged_bodies
from fitter.training.build import read_materials, solved_population
from fitter.training.report.header_figures import measured_bodies
from fitter.vocabulary.choices import Gender
from tests.evaluation.landmark_points import packaged_model
from tests.evaluation.table import MEASUREMENTS

SUBJECTS, HELD_OUT = 1300, 200
"""Of the packaged population; the first were never trained on."""

LEVELS = 80
"""Heights at which a width is taken, as shares of the stature."""

SOLES_AND_CROWN = slice(3, 78)
"""The levels between them; hair and toes say nothing of girths."""

WIDTH_KNOWN_TO_M = 0.001

VIEWS: Mapping[str, tuple[int, ...]] = {"front": (0,), "side": (2,), "front and side": (0, 2)}
"""The body axes along which each view sees widths."""


def outline_limit(gender: Gender) -> Mapping[str, Mapping[str, float]]:
    """Mean absolute errors on held-out subjects by view and measurement, centimetres, kilograms.

    Takes half a minute, most of it measuring 1,300 bodies.
    """
    materials = read_materials()[gender.value]
    population = solved_population(materials, count=SUBJECTS, seed=1)
    model = packaged_model(gender)
    bodies = np.asarray(rigged_bodies(materials.mesh, population.source_vertices).rest)
    measured = measured_bodies(model, bodies)
    statures = np.ptp(bodies[..., 1], axis=1)
    beside = ~_on_arms(model)
    names = [definition.about.name for definition in load_definitions()]
    errors: dict[str, Mapping[str, float]] = {}
    for view, axes in VIEWS.items():
        widths = [widths_at_levels(bodies[:, beside], axis) for axis in axes]
        seen = np.column_stack([statures, *widths])
        away = foretelling_errors(seen, measured, held_out=HELD_OUT)
        errors[view] = dict(zip(names, np.abs(away).mean(axis=0).tolist(), strict=True))
    return errors


def widths_at_levels(
    bodies: Float[np.ndarray, "s m 3"], axis: int
) -> Float[np.ndarray, "s levels"]:
    """Extents along an axis of the vertices in each level; 0 where a level has none."""
    widths = np.zeros((len(bodies), LEVELS))
    for row, vertices in enumerate(bodies):
        heights = vertices[:, 1] - vertices[:, 1].min()
        level = np.minimum((LEVELS * heights / heights.max()).astype(int), LEVELS - 1)
        for number in np.unique(level):
            widths[row, number] = np.ptp(vertices[level == number, axis])
    return widths[:, SOLES_AND_CROWN]


def foretelling_errors(
    seen: Float[np.ndarray, "s k"], wanted: Float[np.ndarray, "s d"], *, held_out: int
) -> Float[np.ndarray, "t d"]:
    """Foretold minus true of the first ``held_out`` rows, by ridge regression from the others."""
    tested, taught = slice(0, held_out), slice(held_out, None)
    columns = np.column_stack([np.ones(len(seen)), seen - seen[taught].mean(axis=0)])
    ridge = np.full(columns.shape[1], len(seen[taught]) * WIDTH_KNOWN_TO_M**2)
    ridge[0] = 0.0
    matrix = columns[taught].T @ columns[taught] + np.diag(ridge)
    weights = np.linalg.solve(matrix, columns[taught].T @ wanted[taught])
    return columns[tested] @ weights - wanted[tested]


def _on_arms(model: BodyModel) -> Bool[np.ndarray, " m"]:
    marked = np.zeros(len(model.mean_vertices), dtype=np.bool_)
    for part, name in enumerate(model.part_names):
        if "arm" in name or "hand" in name:
            marked[model.triangles[model.part_of_triangle == part].ravel()] = True
    return marked


def outline_lines(limits: Mapping[str, Mapping[str, Mapping[str, float]]]) -> list[str]:
    """What exactly known outlines leave of each gender's measurements, mean absolute errors."""
    columns = "".join(f"{f'{name} {unit}':>11s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{'outline from':28s}{columns}"]
    for gender, views in limits.items():
        for view, errors in views.items():
            values = "".join(f"{errors[key]:11.2f}" for _, key, _ in MEASUREMENTS)
            lines.append(f"{f'{view}, {gender}':28s}{values}")
    return lines
