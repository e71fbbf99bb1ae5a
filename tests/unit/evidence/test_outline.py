"""Outlines that are doubtful or loose."""

import numpy as np
import pytest

from fitter.energies.correspondence_lines import correspondence_lines
from fitter.energies.edges import EdgeCostMap
from fitter.evidence.doubtful_outline import (
    AROUND_M,
    BROAD_M,
    OFF_M,
    THING_M,
    doubtful_outline,
    outgrown_m,
)
from fitter.evidence.loose_outline import FARTHEST_M, LooseOutline
from fitter.evidence.silhouette_evidence import silhouette_evidence
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
THING = np.array([0.2, 0.3, 0.7], dtype=np.float32)
rows, columns = np.indices((HEIGHT, WIDTH))
OFF_PX, AROUND_PX = OFF_M * PIXELS_PER_METRE, AROUND_M * PIXELS_PER_METRE


def body() -> np.ndarray:
    return boxes(BODY)[0].silhouette


def block(top: int, bottom: int, left: int, right: int) -> np.ndarray:
    return (rows >= top) & (rows < bottom) & (columns >= left) & (columns < right)


def shown(person: np.ndarray, *things: np.ndarray) -> np.ndarray:
    display = np.where(person[..., None], SKIN, WALL).astype(np.float32)
    for thing in things:
        display[thing] = THING
    return display


def doubtful(
    mask: np.ndarray,
    display: np.ndarray,
    confidence: np.ndarray | None = None,
    cloth: np.ndarray | None = None,
) -> np.ndarray:
    return doubtful_outline(silhouette_evidence(mask, confidence, cloth), boxes(BODY)[0], display)


@pytest.mark.parametrize("change_px", [0, 3])
def test_an_outline_near_the_body_is_not_doubted(change_px: int):
    assert change_px < OFF_PX
    tall = np.flatnonzero(body().any(axis=1))
    wider = block(tall[0], tall[-1] + 1, 130 - change_px, 190 + change_px)
    assert not doubtful(wider, shown(wider)).any()


def test_a_thing_before_the_person_is_followed_by_its_colour_from_where_it_sticks_out():
    thing = block(100, 140, 115, 205)
    found = doubtful(body() | thing, shown(body(), thing))
    assert found[thing].all()
    assert not found[: 100 - int(AROUND_PX) - 1].any()
    assert not found[141 + int(AROUND_PX) :].any()


def test_what_has_the_persons_colours_is_doubted_where_it_sticks_out_alone():
    arm = block(42, 54, 50, 160)
    found = doubtful(body() | arm, shown(body() | arm))
    assert found[arm & (columns < 120)].all()
    # Farther away than a thing that covers the person reaches, the body has its colour too.
    assert np.hypot(200 - 54, 190 - 130) > THING_M * PIXELS_PER_METRE
    assert not found[:, 150:].any()


def test_what_is_missing_deep_inside_the_body_is_doubted():
    bag = block(90, 130, 100, 160)
    found = doubtful(body() & ~bag, shown(body(), bag))
    border = block(95, 125, 129, 131)
    assert found[bag & body() & (columns > 131 + OFF_PX)].all()
    assert found[border].mean() > 0.5
    assert not found[160:].any()


def test_speckle_and_what_lies_at_hair_and_hands_is_not_doubted():
    speck, hair = block(100, 103, 200, 203), block(60, 90, 195, 225)
    sure = np.where(hair, np.float32(0.05), np.float32(1.0))
    mask = body() | speck | hair
    assert not doubtful(mask, shown(mask), sure).any()
    assert doubtful(mask, shown(mask)).any()


def test_loose_clothes_may_stand_off():
    skirt = block(100, 140, 115, 205)
    mask = body() | skirt
    assert not doubtful(mask, shown(body(), skirt), cloth=skirt.astype(np.float32)).any()


def test_no_outline_and_no_edge_counts_where_there_is_doubt():
    region = block(0, 100, 0, WIDTH)
    silhouette = silhouette_evidence(body()).doubting(region)
    np.testing.assert_array_equal(silhouette.doubtful, region)
    np.testing.assert_array_equal(silhouette.confidence, np.where(region, 0.0, 1.0))
    edges = EdgeCostMap(cost=np.full((HEIGHT, WIDTH), 0.25, dtype=np.float32)).without(region)
    np.testing.assert_array_equal(edges.cost, np.where(region, np.float32(1.0), np.float32(0.25)))


def outgrown(mask: np.ndarray, display: np.ndarray) -> float:
    everywhere = np.ones_like(mask)
    return outgrown_m(silhouette_evidence(mask), boxes(BODY)[0], everywhere, display)


@pytest.mark.parametrize("reach_px", [12, 20, 30])
def test_a_belly_beyond_the_model_is_the_persons_own_and_told_by_its_reach(reach_px: int):
    belly = block(90, 140, 150, 190 + reach_px)
    found = outgrown(body() | belly, shown(body() | belly))
    assert found == pytest.approx(reach_px / PIXELS_PER_METRE, abs=1.5 / PIXELS_PER_METRE)


def test_a_thing_of_other_colours_is_not_the_persons_own():
    thing = block(100, 125, 150, 210)
    assert outgrown(body() | thing, shown(body(), thing)) == 0.0


def test_an_outline_near_the_body_outgrows_nothing():
    assert outgrown(body(), shown(body())) == 0.0


def test_an_arm_of_another_is_too_narrow_to_be_the_persons_own():
    narrow = int(0.8 * BROAD_M * PIXELS_PER_METRE)
    arm = block(100, 100 + narrow, 150, 220)
    assert outgrown(body() | arm, shown(body() | arm)) == 0.0


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
