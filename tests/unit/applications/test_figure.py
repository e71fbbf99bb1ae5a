import numpy as np

from fitter.applications.figure import GAP_PX, LABEL_HEIGHT_PX, LONGEST_PX, figure_picture
from fitter.export.views import PANEL_HEIGHT_PX, PANEL_WIDTH_PX
from tests.unit.applications.bodies import packaged

RED, BLUE = (200, 20, 20), (20, 20, 200)


def drawn(width: int, height: int):
    body = packaged("male")
    fitted = body.vertices(body.model.canonical_pose)
    reposed = body.vertices(body.model.standing_pose)
    pictures = [np.full((height, width, 3), colour, dtype=np.uint8) for colour in (RED, BLUE)]
    return figure_picture(*pictures, fitted, reposed, body.model.triangles)


def test_four_pictures_stand_side_by_side_in_one_height():
    found = drawn(300, 900)
    scaled = round(300 * PANEL_HEIGHT_PX / 900)
    assert found.shape == (
        PANEL_HEIGHT_PX + LABEL_HEIGHT_PX,
        2 * scaled + 2 * PANEL_WIDTH_PX + 5 * GAP_PX,
        3,
    )
    middle = found[LABEL_HEIGHT_PX + PANEL_HEIGHT_PX // 2]
    assert tuple(middle[GAP_PX + scaled // 2]) == RED
    assert tuple(middle[2 * GAP_PX + scaled + scaled // 2]) == BLUE
    first = 3 * GAP_PX + 2 * scaled
    for left in (first, first + PANEL_WIDTH_PX + GAP_PX):
        body = middle[left : left + PANEL_WIDTH_PX]
        covered = (body < 250).any(axis=1)
        assert 0.1 < covered.mean() < 0.9


def test_a_panorama_is_made_smaller_than_the_bodies():
    found = drawn(9000, 500)
    assert found.shape[1] == 2 * LONGEST_PX + 2 * PANEL_WIDTH_PX + 5 * GAP_PX
    shown = (found[:, GAP_PX + 100] == RED).all(axis=1).sum()
    assert shown == round(500 * LONGEST_PX / 9000)
