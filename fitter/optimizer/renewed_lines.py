"""Searches whose correspondence lines follow the body."""

from collections.abc import Sequence
from dataclasses import replace

from fitter.arrays import Image
from fitter.energies.objective import Body, Objective
from fitter.evidence.correspondence_lines import correspondence_lines
from fitter.evidence.loose_outline import LooseOutline
from fitter.optimizer.alternation import BodySearch
from fitter.optimizer.gauss_newton import Minimum


def with_lines_about(objective: Objective, body: Body, display: Image) -> Objective:
    """The objective with lines placed across the contour of a body near the person.

    ``display`` (h, w, 3) holds the picture's display values in [0, 1].
    """
    seen = objective.see(body)
    silhouette = objective.evidence.silhouette
    clothes = None
    if silhouette.cloth is not None:
        clothes = LooseOutline(mask=silhouette.mask, cloth=silhouette.cloth)
    return objective.with_lines(
        correspondence_lines(seen.rendering, seen.edges, display, silhouette.confidence, clothes)
    )


def renewing_lines(searches: Sequence[BodySearch], display: Image) -> BodySearch:
    """Searches in sequence, each with lines placed along the contour of the body it starts from."""

    def search(objective: Objective, start: Body) -> Minimum:
        found: list[Minimum] = []
        for each in searches:
            start = objective.see(start)
            found.append(each(with_lines_about(objective, start, display), start))
            start = found[-1].candidate
        return replace(found[-1], evaluations=sum(each.evaluations for each in found))

    return search
