"""Tapes round a cylinder: half of each is seen, from any side."""

import numpy as np
import pytest

from fitter.export.tape_views import PX_PER_M, TapeView, best_sides, tape_views

RADIUS_M = 0.15
HEIGHT_M = 1.0
SIDES = 96


def ring(height_m: float) -> np.ndarray:
    angles = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    level = np.full_like(angles, height_m)
    return np.stack([RADIUS_M * np.sin(angles), level, RADIUS_M * np.cos(angles)], axis=1)


def cylinder() -> tuple[np.ndarray, np.ndarray]:
    """Closed, its axis upright; triangles counterclockwise from outside."""
    low, high = ring(0.0)[:-1], ring(HEIGHT_M)[:-1]
    ends = np.array([[0.0, 0.0, 0.0], [0.0, HEIGHT_M, 0.0]])
    one = np.arange(SIDES)
    next_one = (one + 1) % SIDES
    foot, top = np.full(SIDES, 2 * SIDES), np.full(SIDES, 2 * SIDES + 1)
    triangles = [
        (one, next_one, one + SIDES),
        (next_one, next_one + SIDES, one + SIDES),
        (next_one, one, foot),
        (one + SIDES, next_one + SIDES, top),
    ]
    return np.concatenate([low, high, ends]), np.concatenate(
        [np.stack(each, axis=1) for each in triangles]
    ).astype(np.int32)


BEHIND = ring(0.5)[SIDES // 3 : 2 * SIDES // 3 + 1]
"""A third of the way round, its middle at the back."""

AT_RIGHT = BEHIND[:, [2, 1, 0]]
SPAN_M = 2.0 * RADIUS_M * np.sin(np.pi / 3.0)
THROUGH = np.array([[0.0, 0.1, 0.0], [0.0, 0.9, 0.0]])


def views() -> dict[str, TapeView]:
    vertices, triangles = cylinder()
    lines = {"girth": ring(0.5), "back": BEHIND, "right": AT_RIGHT, "through": THROUGH}
    found = tape_views(vertices, triangles, lines, straight={"through"})
    return {view.side: view for view in found}


@pytest.mark.parametrize("side", ["front", "side", "back"])
def test_the_front_half_of_a_girth_is_seen_and_spans_the_body(side: str):
    view = views()[side]
    spanned = np.concatenate(view.lines["girth"])
    width = np.ptp(spanned[:, 0])
    # The body's front is nearer than its middle by its radius: a little larger in perspective.
    assert width == pytest.approx(2.0 * RADIUS_M * PX_PER_M, rel=0.03)
    assert view.shown_length("girth") == pytest.approx(width, rel=0.1)
    height, picture_width, _ = view.picture.shape
    assert ((spanned >= 0.0) & (spanned < [picture_width, height])).all()


def test_what_the_body_hides_is_left_out_and_a_straight_line_is_seen_through_it():
    found = views()
    assert found["front"].lines["back"] == ()
    assert found["back"].shown_length("back") == pytest.approx(SPAN_M * PX_PER_M, rel=0.05)
    assert found["side"].shown_length("right") == pytest.approx(SPAN_M * PX_PER_M, rel=0.05)
    for view in found.values():
        assert view.shown_length("through") == pytest.approx(0.8 * PX_PER_M, rel=0.01)


def test_each_tape_has_the_side_it_is_seen_from_best_and_the_front_where_all_are_alike():
    best = best_sides(tuple(views().values()))
    assert best == {"girth": "front", "back": "back", "right": "side", "through": "front"}


def test_the_side_is_the_right_one():
    vertices, triangles = cylinder()
    nose = np.array([[0.0, 0.5, RADIUS_M], [0.0, 0.6, RADIUS_M]])
    (_, side, _) = tape_views(vertices, triangles, {"nose": nose}, straight={"nose"})
    # Seen from their right, people look to the onlooker's right.
    assert side.lines["nose"][0][:, 0].min() > 0.5 * side.picture.shape[1]


def test_the_body_is_pale_on_white():
    front = views()["front"].picture
    assert (front[0] == 255).all()
    assert 140 < front[len(front) // 2, front.shape[1] // 2].mean() < 250
