"""From the lighter body of a search to the whole one, which light and reflectance are told of."""

from dataclasses import replace

from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import ShadingEvidence
from fitter.render.rasterizer import render


def on_whole_body(
    objective: Objective, candidate: Candidate, state: ShadingEvidence
) -> tuple[Objective, Candidate, ShadingEvidence]:
    """The same body on all of its vertices, with the objective's operators and the shading state.

    Vertices that the search left out have no area: they take no part, and are filled in at the
    end. Of the objective and the candidate only what shading reads is exchanged: operators,
    vertices and rendering. Where the search was on the whole body, all is returned as it is.
    """
    whole = objective.operators.whole
    if whole is None:
        return objective, candidate, state
    lifted = whole.lighter.lifted
    vertices = whole.operators.evaluator.vertices(candidate.parameters)
    rendering = render(vertices, whole.operators.model.triangles, candidate.rendering.camera)
    return (
        replace(objective, operators=whole.operators),
        replace(candidate, vertices=vertices, rendering=rendering),
        replace(
            state,
            reflectance=replace(
                state.reflectance,
                albedo=lifted(state.reflectance.albedo),
                specularity=lifted(state.reflectance.specularity),
            ),
            vertex_areas=whole.operators.shaded.areas,
            shadowed=lifted(state.shadowed),
        ),
    )
