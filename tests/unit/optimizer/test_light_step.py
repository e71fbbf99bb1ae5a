"""The light of the alternation, and the shadows that it casts."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body
from fitter.energies.shading import seen_vertices, usable_vertices
from fitter.evidence.intensity import IntensityMap
from fitter.optimizer.gauss_newton import Minimum
from fitter.optimizer.light_step import first_state, with_new_shadows
from fitter.render.shadow import cast_shadow
from tests.unit.optimizer.rendered_scene import LIGHT, RenderedScene, lit_fit, rendered_scene


def as_it_is(objective: JointObjective, bodies: Sequence[Body]) -> Minimum:
    """A search that finds nothing better."""
    return Minimum(candidate=objective.evaluate(bodies), converged=True, evaluations=1)


def seeing_only(scene: RenderedScene, chosen: np.ndarray) -> IntensityMap:
    """The picture, of which no more is trusted than the pixels of some vertices."""
    rendering = scene.objective.evaluate(scene.truth).rendering
    seen = seen_vertices(rendering, scene.intensity)
    counts = [np.zeros(scene.intensity.trusted.shape, dtype=np.int64) for _ in range(2)]
    for count, vertices in zip(counts, (chosen, ~chosen), strict=True):
        columns, rows = np.floor(rendering.projected[vertices & seen]).astype(int).T
        np.add.at(count, (rows, columns), 1)
    only = (counts[0] > 0) & (counts[1] == 0)
    return replace(scene.intensity, trusted=scene.intensity.trusted & only)


def test_a_light_whose_shadows_hide_all_there_is_to_see_is_not_believed():
    high = replace(LIGHT, azimuth=0.0, elevation=1.2)
    dark = rendered_scene(1, high)
    candidate = dark.objective.evaluate(dark.truth)
    triangles = dark.operators.model.triangles
    centre = dark.truth.translation
    hidden = cast_shadow(candidate.vertices, triangles, light=high, body_centre=centre)
    seen = seen_vertices(candidate.rendering, dark.intensity)
    intensity = seeing_only(dark, hidden & seen)
    state = first_state(dark.objective, candidate, intensity, (high,))
    lit = replace(state, light=high)
    kept = with_new_shadows(dark.objective, candidate, lit)
    assert usable_vertices(candidate.rendering, kept).any()
    found = lit_fit(dark, candidate, as_it_is, (high,), intensity)
    assert found is None or np.isfinite(found[1].reflectance.albedo).all()
