import cv2
import numpy as np

from fitter.render.contours import outline_loops


def ring() -> np.ndarray:
    rows, columns = np.mgrid[:200, :240] + 0.5
    radius = np.hypot(columns - 120.0, rows - 100.0)
    return (radius < 80.0) & (radius > 30.0)


def test_a_ring_has_an_outer_and_an_inner_loop_at_its_radii():
    outer, inner = outline_loops(ring())
    for loop, radius in ((outer, 80.0), (inner, 30.0)):
        found = np.hypot(*(loop - [120.0, 100.0]).T)
        assert np.abs(found - radius).max() < 1.5


def test_filled_by_the_even_odd_rule_the_loops_are_the_silhouette():
    silhouette = ring()
    filled = np.zeros(silhouette.shape, dtype=np.uint8)
    cv2.fillPoly(filled, [np.rint(x - 0.5).astype(np.int32) for x in outline_loops(silhouette)], 1)
    wrong = (filled > 0) != silhouette
    # At most the rim's own pixels, where straight pieces replace the staircase.
    assert wrong.sum() < 0.05 * silhouette.sum()


def test_specks_and_emptiness_have_no_outline():
    empty = np.zeros((20, 20), dtype=bool)
    assert outline_loops(empty) == ()
    speck = empty.copy()
    speck[4, 4] = True
    assert outline_loops(speck) == ()
