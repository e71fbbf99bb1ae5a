import numpy as np

from fitter.render.rasterizer import render, shade_image
from tests.unit.render.shapes import box, camera, sphere


def test_a_constant_fills_the_silhouette_and_the_background_stays():
    rendering = render(*sphere(0.5, (0, 0, 2.5)), camera())
    picture = shade_image(rendering, np.full(len(rendering.vertices), 0.7), background=-1.0)
    np.testing.assert_allclose(picture[rendering.silhouette], 0.7, rtol=1e-6)
    np.testing.assert_array_equal(picture[~rendering.silhouette], -1.0)


def test_interpolated_depth_is_the_depth_buffer():
    # z itself is linear on each triangle in space: a perspective-correct interpolation gives it.
    rendering = render(*box((1.0, 0.6, 2.0), (0.6, 0.4, 2.5)), camera())
    picture = shade_image(rendering, rendering.vertices[:, 2], background=np.inf)
    np.testing.assert_allclose(picture, rendering.depth, rtol=1e-5)
