"""The order in which the vertices of a mesh are eliminated when its matrices are factorised.

It is the costly part of such a factorisation and does not depend on values: it is found once for a
mesh, and any part of the mesh keeps it.
"""

import numpy as np
import qdldl
from jaxtyping import Integer
from scipy import sparse


def elimination_order(edges: Integer[np.ndarray, "e 2"], count: int) -> Integer[np.ndarray, " m"]:
    """The vertices of a graph in an order in which a factor stays sparse (minimum degree)."""
    low, high = np.sort(edges, axis=1).T
    every = np.arange(count)
    degrees = np.bincount(edges.reshape(-1), minlength=count) + 1.0
    matrix = sparse.csc_matrix(
        (
            np.concatenate([degrees, np.full(len(edges), -1.0)]),
            (np.concatenate([every, low]), np.concatenate([every, high])),
        ),
        shape=(count, count),
    )
    _, _, order = qdldl.Solver(matrix, upper=True).factors()
    return np.asarray(order, dtype=np.int64)
