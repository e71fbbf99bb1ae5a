import cv2
import numpy as np
import pytest

from fitter.segmentation.bones import BONES
from fitter.vocabulary.choices import Cues
from tests.accuracy.cases import CASES
from tests.accuracy.clicks import CLICK_DEVIATION_PX
from tests.accuracy.files import read_case
from tests.accuracy.true_picture import fit_request

PLACES = np.linspace(0.0, 1.0, 100)[:, None]


@pytest.mark.parametrize("name", CASES)
def test_bones_run_inside_slim_and_heavy_people_but_for_the_clicks_own_error(name):
    files = read_case(CASES[name])
    clicks = fit_request(files, Cues.SE).views[0].clicks
    outside_px = cv2.distanceTransform((~files.person_mask).astype(np.uint8), cv2.DIST_L2, 5)
    for bone in BONES:
        if not all(point in clicks and not clicks[point].occluded for point in bone):
            continue
        start, end = ((clicks[point].x, clicks[point].y) for point in bone)
        along = (1.0 - PLACES) * start + PLACES * end
        columns, rows = along.astype(int).T
        # Tops of heads and noses lie on the outline: one click in 460 is this far off.
        assert outside_px[rows, columns].max() <= 3.5 * CLICK_DEVIATION_PX, bone
