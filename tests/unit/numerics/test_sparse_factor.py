"""Solves by a sparse factor against dense ones."""

import numpy as np
import pytest
import qdldl
from scipy import sparse

from fitter.numerics.sparse_factor import sparse_factor


def grid_laplacian(side: int, *, held: float) -> sparse.csc_matrix:
    """Of a square grid of vertices, with a weight on the first one."""
    line = 2.0 * np.eye(side) - np.eye(side, k=1) - np.eye(side, k=-1)
    matrix = np.kron(line, np.eye(side)) + np.kron(np.eye(side), line)
    matrix[0, 0] += held
    return sparse.csc_matrix(matrix)


@pytest.mark.parametrize("side", [1, 2, 7, 24])
def test_solutions_are_those_of_a_dense_solver(side):
    matrix = grid_laplacian(side, held=1.0)
    lower, diagonal, permutation = qdldl.Solver(matrix).factors()
    factor = sparse_factor(sparse.csc_matrix(lower), diagonal, permutation)
    right = np.random.default_rng(0).standard_normal((side * side, 3))
    before = right.copy()
    found = factor.solve(right)
    np.testing.assert_allclose(found, np.linalg.solve(matrix.toarray(), right), rtol=1e-9)
    np.testing.assert_array_equal(right, before)
