"""Whether something covers or adjoins the person, so that a part of their outline does not count.

The outline was doubted about the first body near the person
(:mod:`fitter.evidence.doubtful_outline`), and standard errors have grown by that. Here it is told.
Doubt spreads by colours, from a shadow at the feet up a leg too. So it is told only of a body that
what is taken for the person contradicts beside or on what is measured.
"""

from collections.abc import Mapping, Sequence
from typing import Final

import cv2
import numpy as np
from jaxtyping import Integer, Shaped

from fitter.arrays import Mask
from fitter.capture.finding import Box, Code, Finding
from fitter.evidence.doubtful_outline import off_the_body, scale_of
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.render.rasterizer import Rendering
from fitter.segmentation.skin_colour import nearest_of
from fitter.vocabulary.outcomes import Severity

PARTS: Final[Mapping[str, frozenset[str]]] = {
    "trunk": frozenset({"chest", "spine"}),
    "hips": frozenset({"pelvis"}),
    "thighs": frozenset({"thigh"}),
    "lower legs": frozenset({"shin"}),
    "arms": frozenset({"arm", "forearm"}),
}
"""By the last word of the names of the body model's parts. At head, hands and feet hair, what is
held, shoes and shadows are usual."""

LEAST_OFF_M2: Final = 4e-3
"""Area that contradicts the body, at its distance, from which on it is told. Of 236 fits of the
tuning half, clicked and proposed, people as they are have less but for 4, on bricks or with a
shadow; the least behind a box or an arm is 4.5e-3."""

LEAST_SHARE: Final = 0.05
"""Of a part's outline: of what is touched less nothing is told."""


def obstruction(
    silhouette: SilhouetteEvidence,
    rendering: Rendering,
    part_of_triangle: Integer[np.ndarray, " f"],
    part_names: Sequence[str],
    *,
    scale: float,
) -> tuple[Finding, ...]:
    """What is to be told of things before the person or beside them: nothing, or one finding.

    Parameters
    ----------
    silhouette
        With no confidence where it was doubted.
    rendering
        The body as it was found in the picture.
    part_of_triangle
        (f,) index into the names of the body model's parts.
    scale
        Working pixels per pixel of the original.
    """
    doubtful = silhouette.doubtful
    if not doubtful.any() or not rendering.silhouette.any():
        return ()
    parts = _nearest_parts(rendering, part_of_triangle, part_names)
    spilt, missed = off_the_body(silhouette, rendering, doubtful)
    # An arm where none is seen is the body's own mistake more often than a thing before it.
    off = (spilt & (parts != "")) | (missed & (parts != "") & (parts != "arms"))
    if np.count_nonzero(off) < LEAST_OFF_M2 * scale_of(rendering) ** 2:
        return ()
    outline = _outline(rendering.silhouette)
    shares = {
        name: float(np.mean(doubtful[of_part]))
        for name in PARTS
        if (of_part := outline & (parts == name)).any()
    }
    told = {name: share for name, share in shares.items() if share >= LEAST_SHARE}
    if not told:
        return ()
    said = [f"{100.0 * share:.0f} % at the {name}" for name, share in told.items()]
    return (
        Finding(
            code=Code.COVERED,
            severity=Severity.HARMS,
            reason=(
                "Something covers the person, touches their outline or looks like them: of the "
                f"outline {_listed(said)} does not count."
            ),
            remedy="Have nothing and nobody before the person or beside them.",
            box=_box(outline & doubtful & np.isin(parts, list(told)), scale),
        ),
    )


def _nearest_parts(
    rendering: Rendering, part_of_triangle: Integer[np.ndarray, " f"], part_names: Sequence[str]
) -> Shaped[np.ndarray, "h w"]:
    """Which of :data:`PARTS` each pixel shows or is nearest to; empty for head, hands and feet."""
    kinds = [name.rpartition("_")[2] for name in part_names]
    named = np.array(
        [next((part for part, of in PARTS.items() if kind in of), "") for kind in kinds]
    )
    seen = named[part_of_triangle[rendering.face_ids]]
    return seen.ravel()[nearest_of(rendering.silhouette)]


def _outline(silhouette: Mask) -> Mask:
    """(h, w) the outermost pixels; the picture's own border bounds nothing."""
    region = silhouette.astype(np.uint8)
    return silhouette & (cv2.erode(region, np.ones((3, 3), np.uint8)) == 0)


def _box(region: Mask, scale: float) -> Box:
    """Around a region, pixels of the original."""
    rows, columns = np.flatnonzero(region.any(axis=1)), np.flatnonzero(region.any(axis=0))
    sides = columns[0], rows[0], columns[-1] + 1, rows[-1] + 1
    left, top, right, bottom = (float(each) / scale for each in sides)
    return left, top, right, bottom


def _listed(words: Sequence[str]) -> str:
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last
