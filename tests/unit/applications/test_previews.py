import numpy as np
import pytest

from fitter.applications.previews import View, preview
from fitter.export.views import PANEL_HEIGHT_PX, PANEL_WIDTH_PX
from tests.unit.measurement.solids import sphere


def drawn(panel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of what is drawn below the label."""
    rows, columns = np.nonzero((panel[40:] < 250).any(axis=2))
    return rows + 40, columns


def test_bodies_stand_on_one_ground_in_one_scale_and_turn_before_the_onlooker():
    ball, triangles = sphere(radius=0.5, rings=30, sides=60)
    slab = ball * [1.0, 1.8, 0.3] + [3.0, 7.0, -2.0]  # wherever it lies
    small = 0.5 * slab
    picture = preview(
        [
            View(label="slab", vertices=slab),
            View(label="slab, side", vertices=slab, degrees=90.0),
            View(label="small", vertices=small),
        ],
        triangles,
    )
    assert picture.shape == (PANEL_HEIGHT_PX, 3 * PANEL_WIDTH_PX, 3)
    extents = [drawn(panel) for panel in np.split(picture, 3, axis=1)]
    front, side, half = (np.ptp(columns) + 1 for _, columns in extents)
    assert side == pytest.approx(0.3 * front, rel=0.05)
    assert half == pytest.approx(0.5 * front, rel=0.05)
    soles = [rows.max() for rows, _ in extents]
    assert max(soles) - min(soles) <= 4
