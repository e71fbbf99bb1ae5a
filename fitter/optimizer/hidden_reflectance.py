"""Reflectance of what nobody sees: as smooth as it can be, from what is seen.

Eq. 2 asks nothing of a hidden vertex but that it be like its neighbours, so hidden vertices need
no part in the search for the reflectance of the others; they are filled in once, at the end.
"""

from collections.abc import Sequence

import numpy as np
import qdldl
from jaxtyping import Bool, Float, Integer
from scipy import sparse

from fitter.arrays import PerVertex

# Ties what hangs together with nothing known to the mean of what is known.
_RIDGE = 1e-6


def filled_in(
    fields: Sequence[PerVertex],
    known: Bool[np.ndarray, " m"],
    edges: Integer[np.ndarray, "e 2"],
    edge_lengths: Float[np.ndarray, " e"],
) -> list[PerVertex]:
    """Fields whose unknown values are replaced by those that minimise Σ (v_i - v_j)² / d_ij.

    Parameters
    ----------
    fields, known
        Each one value a vertex, and which vertices keep theirs; some must.
    edges, edge_lengths
        The mesh's edges and their lengths d.
    """
    unknown = np.flatnonzero(~known)
    if not len(unknown):
        return list(fields)
    place = np.full(len(known), -1)
    place[unknown] = np.arange(len(unknown))
    stiffness = 1.0 / edge_lengths
    diagonal = np.full(len(unknown), _RIDGE)
    pulls = [np.full(len(unknown), _RIDGE * values[known].mean()) for values in fields]
    for start, end in (edges.T, edges.T[::-1]):
        here = ~known[start]
        np.add.at(diagonal, place[start[here]], stiffness[here])
        given = here & known[end]
        for pull, values in zip(pulls, fields, strict=True):
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
    solver = qdldl.Solver(sparse.csc_matrix(upper), upper=True)
    filled = [values.copy() for values in fields]
    for values, pull in zip(filled, pulls, strict=True):
        values[unknown] = solver.solve(pull)
    return filled
