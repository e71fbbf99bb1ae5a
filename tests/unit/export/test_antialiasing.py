from dataclasses import replace

import numpy as np
import pytest

from fitter.export.antialiasing import PAPER, SAMPLES, render_finely, vertex_pictures
from fitter.export.display import finer, to_levels
from fitter.observation.pixels import display_from_linear
from fitter.render.rasterizer import render, shade_image
from tests.unit.export.plain_pictures import block_means
from tests.unit.export.results import CAMERA
from tests.unit.measurement.solids import sphere


@pytest.fixture(scope="module")
def ball():
    vertices, triangles = sphere(radius=0.3, rings=40, sides=80)
    return vertices + [0.05, -0.1, 2.0], triangles


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
