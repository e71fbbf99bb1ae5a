"""Reflectance of what nobody sees: as smooth as it can be, from what is seen.

Eq. 2 asks nothing of a hidden vertex but that it be like its neighbours, so hidden vertices need
no part in the search for the reflectance of the others; they are filled in once, at the end.
"""

import numpy as np
import qdldl
from jaxtyping import Bool, Float, Integer
from scipy import sparse

from fitter.arrays import PerVertex

# Ties what hangs together with nothing known to the mean of what is known.
_RIDGE = 1e-6


def filled_in(
    values: PerVertex,
    known: Bool[np.ndarray, " m"],
    edges: Integer[np.ndarray, "e 2"],
    edge_lengths: Float[np.ndarray, " e"],
) -> PerVertex:
    """Values with the unknown ones replaced by those that minimise Σ (v_i - v_j)² / d_ij.

    Parameters
    ----------
    values, known
        One a vertex, and whether it is to be kept; some must be.
    edges, edge_lengths
        The mesh's edges and their lengths d.
    """
    unknown = np.flatnonzero(~known)
    if not len(unknown):
        return values
    place = np.full(len(values), -1)
    place[unknown] = np.arange(len(unknown))
    stiffness = 1.0 / edge_lengths
    diagonal = np.full(len(unknown), _RIDGE)
    pull = np.full(len(unknown), _RIDGE * values[known].mean())
    for start, end in (edges.T, edges.T[::-1]):
        here = ~known[start]
        np.add.at(diagonal, place[start[here]], stiffness[here])
        given = here & known[end]
        np.add.at(pull, place[start[given]], stiffness[given] * values[end[given]])
    between = ~known[edges].any(axis=1)
    ends = np.sort(place[edges[between]], axis=1)
    size = len(unknown)
    upper = sparse.coo_array(
        (
            np.concatenate([diagonal, -stiffness[between]]),
            (
                np.concatenate([np.arange(size), ends[:, 0]]),
                np.concatenate([np.arange(size), ends[:, 1]]),
            ),
        ),
        shape=(size, size),
    )
    result = values.copy()
    result[unknown] = qdldl.Solver(sparse.csc_matrix(upper), upper=True).solve(pull)
    return result
