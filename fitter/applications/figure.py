"""The four pictures of the paper's Fig. 10 as one: picture, overlay, recovered body, new pose."""

from collections.abc import Sequence

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.applications.previews import View, preview
from fitter.arrays import Triangles, Vertices
from fitter.export.views import LABEL_COLOUR, PANEL_HEIGHT_PX

LABEL_HEIGHT_PX = 36
GAP_PX = 16
LONGEST_PX = 4 * PANEL_HEIGHT_PX
"""A panorama is made smaller than the bodies beside it."""

Levels = UInt8[np.ndarray, "_ _ 3"]
Panel = UInt8[np.ndarray, "panel_h _ 3"]


def figure_picture(
    picture: Levels,
    overlay: Levels,
    fitted: Vertices,
    reposed: Vertices,
    triangles: Triangles,
    *,
    degrees: float = 0.0,
    pose_name: str = "another pose",
) -> Levels:
    """Picture, overlay, and the body as it was found and as it stands anew.

    Parameters
    ----------
    picture, overlay
        sRGB levels, of any sizes.
    fitted, reposed, triangles
        (m, 3) body frame, metres; both stand on one ground and are seen in one scale.
    degrees
        How far the onlooker of the bodies has walked to the right round them.
    pose_name
        Of the new pose.
    """
    bodies = preview(
        [
            View(label="", vertices=fitted, degrees=degrees),
            View(label="", vertices=reposed, degrees=degrees),
        ],
        triangles,
    )
    one, other = np.split(bodies, 2, axis=1)
    return _row(
        [
            ("picture", _as_high(picture)),
            ("fitted body over it", _as_high(overlay)),
            ("fitted body", one),
            (pose_name, other),
        ]
    )


def _as_high(levels: Levels) -> Panel:
    """As high as a panel, and no wider than :data:`LONGEST_PX`, on white paper."""
    height, width = levels.shape[:2]
    scale = min(PANEL_HEIGHT_PX / height, LONGEST_PX / width)
    size = max(round(width * scale), 1), max(round(height * scale), 1)
    way = cv2.INTER_AREA if scale < 1.0 else cv2.INTER_CUBIC
    scaled = np.asarray(cv2.resize(levels, size, interpolation=way), dtype=np.uint8)
    above = (PANEL_HEIGHT_PX - scaled.shape[0]) // 2
    panel = np.full((PANEL_HEIGHT_PX, scaled.shape[1], 3), 255, dtype=np.uint8)
    panel[above : above + scaled.shape[0]] = scaled
    return panel


def _row(panels: Sequence[tuple[str, Panel]]) -> Levels:
    gap = np.full((PANEL_HEIGHT_PX + LABEL_HEIGHT_PX, GAP_PX, 3), 255, dtype=np.uint8)
    columns = [gap]
    for label, panel in panels:
        heading = np.full((LABEL_HEIGHT_PX, panel.shape[1], 3), 255, dtype=np.uint8)
        cv2.putText(
            heading, label, (2, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.55, LABEL_COLOUR, 1, cv2.LINE_AA
        )
        columns += [np.concatenate([heading, panel]), gap]
    return np.concatenate(columns, axis=1)
