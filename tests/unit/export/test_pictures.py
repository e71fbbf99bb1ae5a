"""Pictures of a result: drawn lines, masks, values on vertices anti-aliased, and PNG."""

import io
from dataclasses import replace

import cv2
import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.export._antialiasing_kernels import levels_of
from fitter.export.antialiasing import PAPER, SAMPLES, render_finely, vertex_pictures
from fitter.export.display import finer, levels_of_linear, png_file, slope_bounds, to_levels
from fitter.export.pictures import (
    INNER_COLOUR,
    OUTER_COLOUR,
    drawing_camera,
    drawing_picture,
    drawing_pixels,
    mask_levels,
    overlay_picture,
    trimap_levels,
)
from fitter.numerics.meshes import mesh_topology
from fitter.observation.pixels import display_from_linear
from fitter.render.rasterizer import render, shade_image
from fitter.segmentation.trimap import TrimapLabel
from tests.unit.export.plain_pictures import block_means
from tests.unit.export.results import CAMERA
from tests.unit.measurement.solids import sphere


@pytest.fixture(scope="module")
def ball():
    vertices, triangles = sphere(radius=0.3, rings=40, sides=80)
    return vertices + [0.05, -0.1, 2.0], triangles


def outlined(picture, vertices, triangles):
    topology = mesh_topology(triangles, vertex_count=len(vertices))
    return overlay_picture(picture, vertices, triangles, topology, CAMERA)


def hue_of(levels, colour):
    """Where a picture, anti-aliased lines on grey, has a line of this colour."""
    offset = levels.astype(float) - levels.mean(axis=2, keepdims=True)
    wanted = np.array(colour) - np.mean(colour)
    length = np.linalg.norm(offset, axis=2)
    along = offset @ wanted / np.linalg.norm(wanted)
    return (length > 30.0) & (along > 0.97 * length)


def test_a_large_picture_is_drawn_at_sixteen_hundred_pixels_and_a_small_one_as_it_is():
    large = replace(CAMERA, width=4000, height=3000, centre_x=2000.0, centre_y=1500.0)
    assert (drawing_camera(large).width, drawing_camera(large).height) == (1600, 1200)
    assert drawing_camera(large).focal_length_px == pytest.approx(0.4 * CAMERA.focal_length_px)
    assert (drawing_camera(CAMERA).width, drawing_camera(CAMERA).height) == (480, 400)


def test_a_picture_is_made_smaller_in_linear_light():
    stripes = np.zeros((40, 3200, 3), dtype=np.uint8)
    stripes[:, ::2] = 255
    camera = replace(CAMERA, width=3200, height=40)
    drawn = drawing_picture(stripes, camera, drawing_camera(camera))
    # Half the light is sRGB level 188, not 128.
    assert drawn.shape == (20, 1600, 3)
    assert set(np.unique(drawn)) == {188}


def test_a_picture_that_was_decoded_at_a_part_of_its_size_is_drawn_like_the_whole():
    camera = replace(CAMERA, width=3999, height=41)
    whole = np.repeat(np.random.default_rng(1).integers(0, 256, (21, 2000, 3)), 2, axis=1)
    whole = np.repeat(whole, 2, axis=0)[:41, :3999].astype(np.uint8)
    size = drawing_camera(camera)
    assert drawing_pixels(camera) <= 3999 * 41 / 2**2
    drawn = drawing_picture(whole, camera, size)
    reduced = drawing_picture(whole[::2, ::2].copy(), camera, size, reduction=2)
    np.testing.assert_allclose(reduced.astype(int), drawn, atol=1)


def test_a_mask_lands_on_the_pixels_it_was_taken_from():
    working = CAMERA.scaled(0.37, width=177, height=148)
    y, x = np.mgrid[: working.height, : working.width]
    centre = np.array([100.3, 61.7])
    mask = np.hypot(x + 0.5 - centre[0], y + 0.5 - centre[1]) < 30.0
    levels = mask_levels(mask, working, CAMERA)
    assert levels.shape == (400, 480)
    assert set(np.unique(levels)) == {0, 255}
    rows, columns = np.nonzero(levels)
    middle = np.array([columns.mean() + 0.5, rows.mean() + 0.5])
    np.testing.assert_allclose(middle * 0.37, centre, atol=0.2)


def test_the_trimap_has_three_levels():
    known = [TrimapLabel.BACKGROUND, TrimapLabel.FOREGROUND]
    unknown = [TrimapLabel.LIKELY_BACKGROUND, TrimapLabel.LIKELY_FOREGROUND]
    labels = np.array([known + unknown], dtype=np.uint8)
    camera = replace(CAMERA, width=4, height=1)
    assert trimap_levels(labels, camera, camera).tolist() == [[0, 255, 128, 128]]


def test_the_outline_is_drawn_where_the_body_ends(ball):
    vertices, triangles = ball
    grey = np.full((CAMERA.height, CAMERA.width, 3), 90, dtype=np.uint8)
    drawn = outlined(grey, vertices, triangles)
    green = np.argwhere(hue_of(drawn, OUTER_COLOUR))[:, ::-1] + 0.5
    silhouette = render(vertices, triangles, CAMERA).silhouette.astype(np.uint8)
    ((outline,), _) = cv2.findContours(silhouette, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    outline = outline[:, 0] + 0.5
    distance = np.linalg.norm(green[:, None] - outline[None], axis=2)
    assert distance.min(axis=1).max() < 2.3, "nothing is drawn off the outline"
    assert distance.min(axis=0).max() < 2.3, "no part of the outline is left out"
    middle = 0.5 * (green.min(axis=0) + green.max(axis=0))
    np.testing.assert_allclose(middle, 0.5 * (outline.min(axis=0) + outline.max(axis=0)), atol=0.6)
    assert (grey == 90).all(), "the picture given is left as it was"


def test_a_ball_before_a_ball_has_an_inner_edge_of_another_colour(ball):
    vertices, triangles = ball
    front = (vertices - [0.05, -0.1, 2.0]) * 0.4 + [0.05, -0.1, 1.5]
    both = np.concatenate([vertices, front])
    together = np.concatenate([triangles, triangles + len(vertices)])
    grey = np.full((CAMERA.height, CAMERA.width, 3), 90, dtype=np.uint8)
    one = hue_of(outlined(grey, vertices, triangles), INNER_COLOUR)
    two = hue_of(outlined(grey, both, together), INNER_COLOUR)
    assert one.sum() == 0
    assert two.sum() > 100


def test_linear_light_is_coded_by_the_table_as_by_the_formula():
    linear = np.linspace(-0.1, 1.1, 400_000).reshape(400, 1000)
    for values in (linear, linear.astype(np.float32), linear[::2, ::-1]):
        plain = to_levels(display_from_linear(values.astype(np.float64))).astype(int)
        difference = np.abs(levels_of_linear(values) - plain)
        # In single precision some few values lie on the other side of a half.
        assert difference.max() <= 1
        assert (difference > 0).mean() < 1e-4
    assert len(levels_of.signatures) == 1, "what is compiled for one serves all"


def test_what_is_no_level_has_the_nearest():
    levels = levels_of_linear(np.array([-np.inf, -1.0, np.nan, 2.0, np.inf]))
    assert levels.tolist() == [0, 0, 0, 255, 255]


def test_slopes_are_bounded_column_by_column():
    points = np.random.default_rng(4).uniform(0.5, 2.0, (200, 3)) - [1.0, 1.0, 0.0]
    flat = points[:, :2] / points[:, 2:]
    low, high = slope_bounds(points)
    np.testing.assert_array_equal(low, flat.min(axis=0))
    np.testing.assert_array_equal(high, flat.max(axis=0))


def test_a_finer_camera_sees_the_same_with_more_pixels(ball):
    vertices, _ = ball
    np.testing.assert_allclose(
        finer(CAMERA, 3).project(vertices), 3 * CAMERA.project(vertices), rtol=1e-12
    )


def plain_picture(columns, vertices, triangles, camera):
    """Rendered whole at the finer size, interpolated, averaged and coded step by step."""
    rendering = render(vertices, triangles, finer(camera, SAMPLES))
    seen = [shade_image(rendering, column, background=PAPER) for column in columns]
    means = [block_means(np.clip(channel, 0.0, 1.0), SAMPLES) for channel in seen]
    return np.stack([to_levels(display_from_linear(mean)) for mean in means], axis=2)


@pytest.mark.parametrize(
    "camera",
    [
        CAMERA,
        pytest.param(replace(CAMERA, centre_x=20.0, centre_y=380.0), id="over the border"),
        pytest.param(replace(CAMERA, centre_x=-900.0), id="beside the picture"),
        pytest.param(CAMERA.scaled(9.0, width=480, height=400), id="wider than the picture"),
    ],
)
def test_in_one_pass_as_step_by_step(ball, camera):
    vertices, triangles = ball
    draws = np.random.default_rng(3)
    colours, grey = draws.normal(0.4, 0.5, (len(vertices), 3)), draws.random(len(vertices))
    coloured, pale = vertex_pictures([colours, grey], render_finely(vertices, triangles, camera))
    for picture, columns in ((coloured, colours.T), (pale, [grey] * 3)):
        plain = plain_picture(columns, vertices, triangles, camera)
        difference = np.abs(picture.astype(int) - plain)
        # The plain means are in single precision: they may fall on the other side of a half.
        assert difference.max() <= 1
        assert (difference > 0).mean() < 1e-4


def test_a_mesh_that_reaches_behind_the_camera_is_drawn_as_far_as_it_is_before_it(ball):
    vertices, triangles = ball
    near = vertices - [0.05, -0.1, 1.9]
    grey = np.full(len(near), 0.5)
    (picture,) = vertex_pictures([grey], render_finely(near, triangles, CAMERA))
    np.testing.assert_array_equal(picture, plain_picture([grey] * 3, near, triangles, CAMERA))


def test_a_value_on_vertices_is_shown_in_display_levels_on_white(ball):
    vertices, triangles = ball
    fine = render_finely(vertices, triangles, CAMERA)
    colours = np.tile([0.5, 0.0, 2.0], (len(vertices), 1))
    grey, coloured = vertex_pictures([np.full(len(vertices), 0.5), colours], fine)
    x, y = CAMERA.project(vertices.mean(axis=0)).astype(int)
    assert grey[y, x].tolist() == [188, 188, 188]
    assert grey[5, 5].tolist() == [255, 255, 255]
    assert coloured[y, x].tolist() == [188, 0, 255]


def test_every_level_is_reached_as_by_rounding(ball):
    vertices, triangles = ball
    fine = render_finely(vertices, triangles, CAMERA)
    x, y = CAMERA.project(vertices.mean(axis=0)).astype(int)
    values = np.linspace(0.0, 1.0, 300)
    pictures = vertex_pictures([np.full(len(vertices), value) for value in values], fine)
    shown = pictures[:, y, x, 0]
    np.testing.assert_array_equal(shown, to_levels(display_from_linear(values)))


def test_rims_are_anti_aliased(ball):
    vertices, triangles = ball
    fine = render_finely(vertices, triangles, CAMERA)
    (picture,) = vertex_pictures([np.zeros(len(vertices))], fine)
    between = (picture[..., 0] > 0) & (picture[..., 0] < 255)
    assert between.sum() > 200


def smooth_picture(height, width, channels):
    """Slopes, noise on a part of them, and a large even part."""
    draws = np.random.default_rng(105)
    y, x, c = np.mgrid[:height, :width, :channels]
    picture = 40.0 + 0.3 * x + 0.2 * y + 9.0 * c
    picture[: height // 2, : width // 2] += draws.normal(
        0.0, 4.0, (height // 2, width // 2, channels)
    )
    picture[height // 2 :, width // 2 :] = 255.0
    return picture.clip(0.0, 255.0).astype(np.uint8)


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize(("height", "width"), [(1, 1), (3, 7), (240, 321)])
def test_pictures_are_read_by_others_as_they_were_written(height, width, channels):
    levels = smooth_picture(height, width, channels)
    content = png_file(levels)
    with PillowImage.open(io.BytesIO(content)) as picture:
        picture.verify()
    with PillowImage.open(io.BytesIO(content)) as picture:
        assert picture.mode == {1: "L", 3: "RGB", 4: "RGBA"}[channels]
        np.testing.assert_array_equal(np.asarray(picture).reshape(levels.shape), levels)
    read = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED)
    assert read is not None
    order = [0] if channels == 1 else [2, 1, 0, 3][:channels]
    np.testing.assert_array_equal(read.reshape(levels.shape)[..., order], levels)


def test_files_are_about_as_large_as_opencvs():
    levels = smooth_picture(480, 640, 3)
    settings = (cv2.IMWRITE_PNG_COMPRESSION, 1, cv2.IMWRITE_PNG_STRATEGY, 3)
    _, content = cv2.imencode(".png", levels[..., ::-1], settings)
    assert len(png_file(levels)) < 1.1 * len(content)


def test_a_view_of_a_picture_is_written_like_a_copy():
    levels = smooth_picture(40, 60, 3)
    assert png_file(levels[5:, ::2, ::-1]) == png_file(levels[5:, ::2, ::-1].copy())
