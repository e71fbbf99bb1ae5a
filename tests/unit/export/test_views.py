import numpy as np
import pytest

from fitter.export.views import (
    PANEL_HEIGHT_PX,
    PANEL_WIDTH_PX,
    BodyView,
    framing_camera,
    preview,
    turned_about_vertical,
    under_level_camera,
    views_picture,
)
from fitter.parameters import CameraTilt
from fitter.vocabulary.outcomes import StanceKind
from tests.unit.measurement.solids import sphere

ROOT = np.array([0.2, -0.1, 3.0])


@pytest.fixture(scope="module")
def slab():
    """Wide, tall and thin: 0.6 x 0.9 x 0.12 m, in the body frame."""
    vertices, triangles = sphere(radius=0.3, rings=40, sides=80)
    return vertices * [1.0, 1.5, 0.2], triangles


def test_walking_to_the_right_brings_the_right_to_the_front():
    right = ROOT + [0.5, 0.2, 0.0]
    near = ROOT + [0.0, 0.2, -0.5]
    turned = turned_about_vertical(np.stack([right, near]), ROOT, 90.0)
    np.testing.assert_allclose(turned[0], ROOT + [0.0, 0.2, -0.5], atol=1e-12)
    np.testing.assert_allclose(turned[1], ROOT + [-0.5, 0.2, 0.0], atol=1e-12)


def test_under_a_tilted_camera_the_side_view_turns_about_the_worlds_vertical():
    tilt = CameraTilt(
        pitch=np.radians(-20.0), roll=0.0, covariance=np.eye(2), stances={StanceKind.STANDING: 1.0}
    )
    above = ROOT + 0.5 * tilt.up
    level = under_level_camera(np.stack([ROOT, above]), ROOT, tilt)
    np.testing.assert_allclose(level, [ROOT, ROOT + [0.0, -0.5, 0.0]], atol=1e-12)
    np.testing.assert_array_equal(under_level_camera(level, ROOT, None), level)


def test_the_framed_body_touches_the_margins_and_keeps_its_perspective(slab):
    vertices = slab[0] * [1, -1, -1] + ROOT
    camera = framing_camera(vertices, width=520, height=720)
    pixels = camera.project(vertices)
    np.testing.assert_allclose(pixels.min(axis=0)[1], 0.06 * 720, atol=0.5)
    np.testing.assert_allclose(pixels.max(axis=0)[1], 0.94 * 720, atol=0.5)
    assert pixels[:, 0].mean() == pytest.approx(260, abs=3.0)


def test_two_panels_show_a_thin_body_wide_from_the_front_and_thin_from_the_side(slab):
    vertices, triangles = slab
    picture = views_picture(vertices * [1, -1, -1] + ROOT, ROOT, None, triangles)
    assert picture.shape == (PANEL_HEIGHT_PX, 2 * PANEL_WIDTH_PX, 3)
    below_labels = picture[60:, :, 2] < 230
    widths = [int(panel.any(axis=0).sum()) for panel in np.split(below_labels, 2, axis=1)]
    assert widths[0] > 4 * widths[1]


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
            BodyView(label="slab", vertices=slab),
            BodyView(label="slab, side", vertices=slab, degrees=90.0),
            BodyView(label="small", vertices=small),
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
