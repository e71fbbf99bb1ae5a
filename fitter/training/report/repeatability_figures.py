"""How far a body's measurements repeat: moved rigidly, mirrored, and with noise on its mesh."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.measurement.affine_body import affine_body
from fitter.measurement.anthropometry import measurement_values, measuring_body
from fitter.measurement.mesh_measurement import in_body_frame, mesh_measurement_values
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines

BODIES = 100
"""Each with a rotation, a translation and noise of its own."""

SHIFT_M = 3.0
NOISE_M = 1e-4

_SEED = 1000


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RepeatabilityFigures:
    """Largest changes of k measurements over random bodies, in their units.

    ``moved`` by any rotation and up to metres, the upright found from the mesh alone; ``mirrored``
    left to right; ``noisy`` with a tenth of a millimetre of noise on every coordinate.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    moved: Float[np.ndarray, " k"]
    mirrored: Float[np.ndarray, " k"]
    noisy: Float[np.ndarray, " k"]


def repeatability_figures(
    model: BodyModel, rng: np.random.Generator, *, bodies: int = BODIES
) -> RepeatabilityFigures:
    """Change the meshes of random bodies of a model and measure them again."""
    evaluator = ScapeEvaluator(model)
    body = measuring_body(model, evaluator)
    poses = (body.canonical, affine_body(evaluator, model.standing_pose))
    largest = np.zeros((3, len(body.definitions)))
    for rotation in Rotation.random(bodies, rng).as_matrix():
        shape = rng.normal(size=len(model.shape_basis))
        shift = rng.uniform(-SHIFT_M, SHIFT_M, 3)
        before = measurement_values(body, shape)
        meshes = [(posed, posed.at(shape)) for posed in poses]
        moved = [in_body_frame(posed, body, mesh @ rotation.T + shift) for posed, mesh in meshes]
        mirrored = [(mesh * [-1.0, 1.0, 1.0])[model.mirror] for _, mesh in meshes]
        noisy = [mesh + rng.normal(scale=NOISE_M, size=mesh.shape) for _, mesh in meshes]
        changes = [
            np.abs(mesh_measurement_values(body, canonical, standing) - before)
            for canonical, standing in (moved, mirrored, noisy)
        ]
        largest = np.maximum(largest, changes)
    return RepeatabilityFigures(
        names=tuple(definition.about.name for definition in body.definitions),
        units=tuple(definition.about.unit.value for definition in body.definitions),
        moved=largest[0],
        mirrored=largest[1],
        noisy=largest[2],
    )


def repeatability_lines(reported: Reported) -> tuple[str, ...]:
    """The section of the report."""
    figures = repeatability_figures(reported.model, np.random.default_rng(_SEED))
    rows = []
    for k, (name, unit) in enumerate(zip(figures.names, figures.units, strict=True)):
        scale, shown = (10.0, "mm") if unit == "cm" else (1000.0, "g")
        changes = (figures.moved[k], figures.mirrored[k], figures.noisy[k])
        rows.append((name, shown, *(f"{scale * change:.2g}" for change in changes)))
    return (
        *table_lines(
            f"measured again, largest change over {BODIES} people drawn from N(0, I)",
            ("", "unit", "moved rigidly", "mirrored", "0.1 mm of noise"),
            rows,
        ),
        *note_lines(
            "Moved: by a random rotation and metres, the body's upright then found from its mesh. "
            "Mirrored: the right limbs are measured, so the left ones become them; mesh and "
            "pose term are alike on both sides but for rounding and what the solved bodies have."
        ),
    )
