"""Pictures of values that live on vertices: shading, albedo, error maps."""

import numpy as np

from fitter.arrays import GreyImage, PerVertex
from fitter.render import _interpolation_kernels
from fitter.render.rasterizer import Rendering


def shade_image(
    rendering: Rendering, values_per_vertex: PerVertex, *, background: float = 0.0
) -> GreyImage:
    """(h, w) float32 picture of (m,) values, interpolated linearly over each visible triangle."""
    return _interpolation_kernels.interpolate(
        rendering.face_ids,
        rendering.triangles,
        rendering.projected,
        np.ascontiguousarray(rendering.vertices[:, 2]),
        np.ascontiguousarray(values_per_vertex, dtype=np.float64),
        background,
    )
