"""Searches whose correspondence lines follow the body."""

from collections.abc import Sequence
from dataclasses import replace

from fitter.arrays import Image
from fitter.energies.objective import Objective
from fitter.evidence.correspondence_lines import correspondence_lines
from fitter.evidence.loose_outline import LooseOutline
from fitter.optimizer.alternation import BodySearch
from fitter.optimizer.gauss_newton import Minimum
from fitter.parameters import BodyParameters
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render


def with_lines_about(objective: Objective, body: BodyParameters, display: Image) -> Objective:
    """The objective with lines placed across the contour of a body near the person.

    ``display`` (h, w, 3) holds the picture's display values in [0, 1].
    """
    operators, evidence = objective.operators, objective.evidence
    vertices = operators.evaluator.vertices(body)
    rendering = render(vertices, operators.model.triangles, evidence.camera)
    edges = model_edges(rendering, operators.topology)
    silhouette = evidence.silhouette
    clothes = None
    if silhouette.cloth is not None:
        clothes = LooseOutline(mask=silhouette.mask, cloth=silhouette.cloth)
    return objective.with_lines(
        correspondence_lines(rendering, edges, display, silhouette.confidence, clothes)
    )


def renewing_lines(searches: Sequence[BodySearch], display: Image) -> BodySearch:
    """Searches in sequence, each with lines placed along the contour of the body it starts from."""

    def search(objective: Objective, start: BodyParameters) -> Minimum:
        found: list[Minimum] = []
        for each in searches:
            found.append(each(with_lines_about(objective, start, display), start))
            start = found[-1].candidate.parameters
        return replace(found[-1], evaluations=sum(each.evaluations for each in found))

    return search
