"""The hue of the albedo, for display only: Eq. 1 itself uses luminance alone."""

import numpy as np

from fitter.arrays import Image, PerVertex, Vertices
from fitter.energies.objective import Candidate
from fitter.energies.shading import seen_vertices
from fitter.evidence.intensity import IntensityMap
from fitter.evidence.sampling import sample
from fitter.optimizer.hidden_reflectance import HiddenVertices

_LEAST_LUMINANCE = 1e-3
_STRONGEST_HUE = 4.0
"""Limit as a multiple of luminance: blue weighs only 0.07 in it, so noise would tint dark blue."""


def albedo_rgb(
    candidate: Candidate,
    albedo: PerVertex,
    linear_rgb: Image,
    intensity: IntensityMap,
    hidden: HiddenVertices,
) -> Vertices:
    """Linear RGB albedo (m, 3): the albedo with the picture's hue, carried on to hidden vertices.

    The light is taken as white: a coloured light colours the albedo.
    """
    seen = seen_vertices(candidate.rendering, intensity)
    points = candidate.rendering.projected[seen]
    luminance = np.maximum(intensity.at(points), _LEAST_LUMINANCE)
    rgb = np.empty((len(albedo), 3))
    for channel in range(3):
        there = sample(np.ascontiguousarray(linear_rgb[..., channel]), points)[0]
        hue = np.zeros(len(albedo))
        hue[seen] = np.clip(there / luminance, 0.0, _STRONGEST_HUE)
        # Vertices in a shadow have a hue, though their brightness says nothing.
        rgb[:, channel] = albedo * np.where(seen, hue, hidden.filled(hue))
    return np.maximum(rgb, 0.0)
