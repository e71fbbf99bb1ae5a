import numpy as np
import trimesh

from fitter.training.report.body_sheets import (
    FLOOR_M,
    FRONT,
    LINE_COLOUR,
    SIDE,
    TITLE_PX,
    Panel,
    scale_for,
    sheet,
)

SPHERE = trimesh.creation.icosphere(subdivisions=3)
TRIANGLES = np.asarray(SPHERE.faces, dtype=np.int32)


def pillar(height_m: float, width_m: float = 0.4, depth_m: float = 0.2) -> np.ndarray:
    return np.asarray(SPHERE.vertices) * [0.5 * width_m, 0.5 * height_m, 0.5 * depth_m]


def panel(vertices, degrees=FRONT, lines_m=()) -> Panel:
    return Panel(vertices=vertices, degrees=degrees, label="", lines_m=lines_m)


def drawn(vertices, scale, degrees=FRONT, lines_m=()) -> np.ndarray:
    """The panel alone, without its title."""
    picture = sheet({"": [panel(vertices, degrees, lines_m)]}, TRIANGLES, scale, groups_per_row=1)
    return picture[TITLE_PX:, : scale.width_px]


def body_extent(picture: np.ndarray, axis: int) -> tuple[int, int]:
    """First and last row or column with anything but paper and lines."""
    paper = (picture == 255).all(axis=2) | (picture == LINE_COLOUR).all(axis=2)
    found = np.flatnonzero((~paper).any(axis=1 - axis))
    return int(found[0]), int(found[-1])


def test_bodies_stand_on_the_floor_line_and_reach_as_high_as_they_are_tall():
    bodies = [pillar(1.5), pillar(2.0)]
    scale = scale_for(bodies, px_per_m=200.0)
    floor = scale.height_px - FLOOR_M * scale.px_per_m
    for body, height_m in zip(bodies, (1.5, 2.0), strict=True):
        top, bottom = body_extent(drawn(body, scale), axis=0)
        assert abs(bottom - floor) <= 3
        assert abs((floor - top) - 200.0 * height_m) <= 3


def test_a_line_runs_at_its_height():
    body = pillar(1.5)
    scale = scale_for([body], px_per_m=200.0)
    picture = drawn(body, scale, lines_m=(1.0,))
    rows = np.flatnonzero((picture[:, 0] != 255).any(axis=1))
    floor = scale.height_px - FLOOR_M * scale.px_per_m
    np.testing.assert_array_equal(rows, [round(floor - 200.0), round(floor)])


def test_from_the_side_a_body_shows_its_depth():
    body = pillar(1.5, width_m=0.6, depth_m=0.3)
    scale = scale_for([body], px_per_m=200.0)
    for degrees, size_m in ((FRONT, 0.6), (SIDE, 0.3)):
        left, right = body_extent(drawn(body, scale, degrees), axis=1)
        assert abs((right - left) - 200.0 * size_m) <= 4


def test_seen_from_the_front_the_persons_left_is_at_the_right_of_the_picture():
    body = pillar(1.5)
    body[body[:, 0] > 0.0, 0] *= 2.0
    scale = scale_for([body], px_per_m=200.0)
    left, right = body_extent(drawn(body, scale), axis=1)
    assert right - 0.5 * scale.width_px > 1.5 * (0.5 * scale.width_px - left)


def test_groups_fill_rows_and_the_rest_stays_white():
    body = pillar(1.5)
    scale = scale_for([body], px_per_m=100.0)
    three = {name: [panel(body)] for name in ("a", "b", "c")}
    picture = sheet(three, TRIANGLES, scale, groups_per_row=2)
    height = scale.height_px + TITLE_PX
    assert picture.shape[0] == 2 * height
    blank = picture[height:, picture.shape[1] // 2 :]
    assert (blank == 255).all()
    assert not (picture[height:, : picture.shape[1] // 2] == 255).all()
