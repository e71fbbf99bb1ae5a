"""Correspondence lines that follow the body."""

from fitter.arrays import Image
from fitter.energies.objective import Body, Objective
from fitter.evidence.correspondence_lines import correspondence_lines
from fitter.evidence.loose_outline import LooseOutline


def with_lines_about(objective: Objective, body: Body, display: Image) -> Objective:
    """The objective with lines placed across the contour of a body near the person.

    ``display`` (h, w, 3) holds the picture's display values in [0, 1].
    """
    seen = objective.see(body)
    silhouette = objective.evidence.silhouette
    clothes = None
    if silhouette.cloth is not None and silhouette.fullness is not None:
        clothes = LooseOutline(
            mask=silhouette.mask, cloth=silhouette.cloth, fullness=silhouette.fullness
        )
    return objective.with_lines(
        correspondence_lines(seen.rendering, seen.edges, display, silhouette.confidence, clothes)
    )
