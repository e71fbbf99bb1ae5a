"""Where the outline of loose clothes lies beside a body's contour, on drawn boxes."""

import numpy as np
import pytest

from fitter.energies.correspondence_lines import correspondence_lines
from fitter.evidence.loose_outline import FARTHEST_M, LooseOutline
from tests.unit.evidence.drawn_pictures import (
    HEIGHT,
    PIXELS_PER_METRE,
    SKIN,
    WALL,
    WIDTH,
    boxes,
    coverage,
    picture,
)

BODY = (130.0, 190.0)
SURE = np.ones((HEIGHT, WIDTH), dtype=np.float32)


def clothes(left: float, right: float, cloth: float = 1.0) -> LooseOutline:
    """Upright stripes of clothes from the top to the bottom of the picture."""
    columns = np.arange(WIDTH) + 0.5
    mask = np.tile((columns > left) & (columns < right), (HEIGHT, 1))
    return LooseOutline(
        mask=mask,
        cloth=np.full(mask.shape, cloth, dtype=np.float32),
        fullness=np.broadcast_to(np.float32([0.25, 1.5]), (*mask.shape, 2)),
    )


def beyond(outline: LooseOutline, *bodies: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    rendering, edges = boxes(*bodies)
    outer = edges.visible & edges.is_outer_silhouette
    centres, normals = edges.endpoints[outer].mean(axis=1), edges.outward[outer]
    return outline.beyond(rendering, centres, normals), normals


@pytest.mark.parametrize("ease", [-6.0, 0.0, 5.0, 30.0])
def test_the_outline_is_found_as_far_from_the_contour_as_it_is(ease):
    found, normals = beyond(clothes(BODY[0] - ease, BODY[1] + ease), BODY)
    aside = np.abs(normals[:, 0]) > 0.99
    np.testing.assert_allclose(found[aside], ease, atol=1.01)


def test_an_outline_out_of_reach_is_none():
    far = FARTHEST_M * PIXELS_PER_METRE + 5.0
    found, normals = beyond(clothes(BODY[0] - far, BODY[1] + far), BODY)
    assert np.isnan(found[np.abs(normals[:, 0]) > 0.99]).all()


def test_clothes_that_bridge_a_gap_say_nothing_of_the_limbs_beside_it():
    left, right = (110.0, 150.0), (170.0, 210.0)
    found, normals = beyond(clothes(100.0, 220.0), left, right)
    aside = np.abs(normals[:, 0]) > 0.99
    assert np.isnan(found[aside]).sum() >= 2
    np.testing.assert_allclose(found[aside & np.isfinite(found)], 10.0, atol=1.01)


def test_lines_find_the_boundary_of_clothes_far_outside_the_body():
    ease = 20.0
    rendering, edges = boxes(BODY)
    noise = np.random.default_rng(3).standard_normal((HEIGHT, WIDTH, 3))
    display = picture(SKIN, WALL, coverage(BODY[0] - ease, BODY[1] + ease)) + 0.01 * noise
    rough = clothes(BODY[0] - ease - 3.0, BODY[1] + ease + 3.0, cloth=0.7)
    lines = correspondence_lines(rendering, edges, display, SURE, rough)
    aside = np.abs(lines.normals[:, 0]) > 0.99
    assert aside.any()
    np.testing.assert_allclose(np.median(lines.offsets[aside]), ease, atol=0.5)
    np.testing.assert_allclose(lines.cloth, 0.7, atol=1e-6)
    np.testing.assert_allclose(lines.fullness, np.tile([0.25, 1.5], (len(lines.cloth), 1)))
