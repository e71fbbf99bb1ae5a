"""The hue of the albedo, for people to look at: Eq. 1 itself knows luminance only."""

import numpy as np
import qdldl
from scipy import sparse

from fitter.arrays import Image, PerVertex, Vertices
from fitter.energies.objective import Candidate
from fitter.energies.shading import seen_vertices
from fitter.evidence.intensity import IntensityMap
from fitter.evidence.sampling import sample
from fitter.numerics.mesh_topology import MeshTopology

# Neighbours pull unseen vertices to their hue; seen ones hardly.
_SMOOTHNESS = 0.05
_RIDGE = 1e-6


def albedo_rgb(
    candidate: Candidate,
    albedo: PerVertex,
    linear_rgb: Image,
    intensity: IntensityMap,
    topology: MeshTopology,
) -> Vertices:
    """Linear RGB albedo (m, 3): the albedo with the picture's hue, carried on to unseen vertices.

    The light is taken as white: a coloured light colours the albedo.
    """
    m = len(albedo)
    usable = seen_vertices(candidate.rendering, intensity)
    points = candidate.rendering.projected[usable]
    channels = [
        sample(np.ascontiguousarray(linear_rgb[..., channel]), points)[0] for channel in range(3)
    ]
    hue = np.zeros((m, 3))
    luminance = np.maximum(intensity.at(points), 1e-3)
    hue[usable] = np.clip(np.stack(channels, axis=1) / luminance[:, None], 0.0, 4.0)
    first, second = topology.edges.T
    weight = usable.astype(float)
    degree = np.bincount(first, minlength=m) + np.bincount(second, minlength=m)
    diagonal = weight + _SMOOTHNESS * degree + _RIDGE
    matrix = sparse.coo_matrix(
        (
            np.concatenate([diagonal, np.full(len(first), -_SMOOTHNESS)]),
            (
                np.concatenate([np.arange(m), np.minimum(first, second)]),
                np.concatenate([np.arange(m), np.maximum(first, second)]),
            ),
        ),
        shape=(m, m),
    ).tocsc()
    solver = qdldl.Solver(matrix, upper=True)
    spread = np.stack(
        [solver.solve(weight * hue[:, channel] + _RIDGE) for channel in range(3)], axis=1
    )
    return np.clip(albedo[:, None] * spread, 0.0, None)
