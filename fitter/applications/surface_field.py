"""Values of vertices made smooth, or carried on, over a body's surface.

Both minimise Σ (v_i - v_j)² / d_ij over the edges and their lengths d, plus a ridge. Three edges a
vertex in all directions: Σ (v_i - v_j)² / d is Σ 1.5 d |∇v|² over vertices, so that a ridge of
1.5 d / s² makes solutions decay by e over a distance s.
"""

from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy import sparse
from scipy.sparse import linalg

from fitter.body.model import BodyModel
from fitter.numerics.meshes import mesh_topology
from fitter.optimizer.hidden_reflectance import HiddenVertices


def smooth_values(
    model: BodyModel, values: Float[np.ndarray, "m k"], *, over_m: float
) -> Float[np.ndarray, "m k"]:
    """Each value as the mean of those around it, whose weight falls by e over a distance."""
    edges, lengths, ridge = _edges(model, over_m)
    first, second = edges.T
    count, stiffness = len(values), 1.0 / lengths
    both = np.concatenate([first, second]), np.concatenate([second, first])
    neighbours = sparse.coo_array((np.tile(stiffness, 2), both), shape=(count, count))
    diagonal = ridge + np.bincount(both[0], np.tile(stiffness, 2), count)
    matrix = sparse.csc_array(sparse.diags_array(diagonal) - neighbours)
    return np.asarray(linalg.splu(matrix).solve(ridge[:, None] * values))


def extend_values(
    model: BodyModel,
    known: Bool[np.ndarray, " m"],
    values: Float[np.ndarray, "m k"],
    *,
    over_m: float,
) -> Float[np.ndarray, "m k"]:
    """Values of some vertices, and toward 0 away from them, by e over a distance.

    Parameters
    ----------
    known
        Whose values stay; at least one's.
    values
        Of the others without meaning.
    over_m
        Along the surface, metres.
    """
    edges, lengths, ridge = _edges(model, over_m)
    hidden = HiddenVertices.of(known, edges, lengths, ridge=ridge)
    return np.stack([hidden.filled(column, toward=0.0) for column in values.T], axis=1)


@lru_cache(maxsize=2)
def edges_of(model: BodyModel) -> Integer[np.ndarray, "e 2"]:
    """Pairs of neighbouring vertices."""
    return mesh_topology(model.triangles, vertex_count=len(model.mean_vertices)).edges


def _edges(
    model: BodyModel, over_m: float
) -> tuple[np.ndarray, Float[np.ndarray, " e"], Float[np.ndarray, " m"]]:
    """Edges, their lengths on the mean body, and the ridge at each vertex."""
    edges, count = edges_of(model), len(model.mean_vertices)
    first, second = model.mean_vertices[edges.T]
    lengths = np.maximum(np.linalg.norm(first - second, axis=1), 1e-4)
    sums = np.bincount(edges.ravel(), np.repeat(lengths, 2), count)
    return edges, lengths, 1.5 * sums / np.bincount(edges.ravel(), minlength=count) / over_m**2
