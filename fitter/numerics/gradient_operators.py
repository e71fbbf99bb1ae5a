"""Deformation gradients of a triangle mesh and the least squares built on them."""

import numpy as np
from jaxtyping import Integer
from scipy import sparse

from fitter.arrays import PerTriangle, Triangles, Vertices


def gradient_operator(rest: Vertices, triangles: Triangles) -> sparse.csr_array:
    """The in-plane gradient of a function on vertices, two rows a triangle.

    For triangle t with an orthonormal frame (u, v) in its rest plane, rows 2t and 2t + 1 give the
    derivatives along u and v of the linear interpolation of the vertex values. Applied to the
    coordinates of a deformed mesh they are the columns of its deformation gradient that a
    triangle can know; SCAPE's edges carry the same information.

    Returns
    -------
    Sparse (2 f, m).
    """
    a, b, c = (rest[triangles[:, k]] for k in range(3))
    first, second = b - a, c - a
    u = first / np.linalg.norm(first, axis=1, keepdims=True)
    normal = np.cross(first, second)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    v = np.cross(normal, u)
    planar = np.empty((len(triangles), 2, 2))  # edge vectors in the frame, as rows
    planar[:, 0, 0], planar[:, 0, 1] = (first * u).sum(1), (first * v).sum(1)
    planar[:, 1, 0], planar[:, 1, 1] = (second * u).sum(1), (second * v).sum(1)
    inverse = np.linalg.inv(planar)  # gradient = inverse @ (y_b - y_a, y_c - y_a)
    coefficients = np.stack(
        [-inverse.sum(axis=2), inverse[:, :, 0], inverse[:, :, 1]], axis=2
    )  # (f, 2 directions, 3 corners)
    rows = np.repeat(np.arange(2 * len(triangles)), 3)
    columns = np.repeat(triangles, 2, axis=0).reshape(-1)
    return sparse.csr_array(
        (coefficients.reshape(-1), (rows, columns)), shape=(2 * len(triangles), len(rest))
    )


def weighted_laplacian(
    gradient: sparse.csr_array, triangle_weights: PerTriangle
) -> sparse.csr_array:
    """Gᵀ W G: with areas as weights, the cotangent Laplacian. Rows sum to zero."""
    weights = sparse.diags_array(np.repeat(triangle_weights, 2))
    return sparse.csr_array(gradient.T @ weights @ gradient)


def part_laplacians(
    gradient: sparse.csr_array,
    triangle_weights: PerTriangle,
    part_of_triangle: Integer[np.ndarray, " f"],
    part_count: int,
) -> list[sparse.csr_array]:
    """The Laplacian restricted to each part's triangles; they sum to the whole."""
    return [
        weighted_laplacian(gradient, np.where(part_of_triangle == part, triangle_weights, 0.0))
        for part in range(part_count)
    ]
