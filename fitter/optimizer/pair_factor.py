"""Solving with symmetric matrices of one pattern: a mesh's graph, with two unknowns a vertex.

Entries are blocks of two by two. A fit of 0.54 s factorises seventeen times, which takes 26 ms; by
``qdldl.Solver.update`` it is 58 ms, and by SciPy's ``splu`` 144 ms: 6 and 22 % of the fit more.
"""

import numpy as np
from jaxtyping import Float, Integer

from fitter.optimizer._pair_factor_kernels import factor_pattern, factorise, solve_factorised


class PairFactor:
    """L D Lᵀ of matrices of one pattern; :meth:`factorise` before :meth:`solve`.

    Parameters
    ----------
    edges
        (e, 2) of the mesh.
    order
        (m,) its vertices in the order of elimination (:func:`elimination_order`).
    """

    def __init__(self, edges: Integer[np.ndarray, "e 2"], order: Integer[np.ndarray, " m"]) -> None:
        self._order = order
        rank = np.empty(len(order), dtype=np.int64)
        rank[order] = np.arange(len(order))
        ranks = np.sort(rank[edges], axis=1)
        self._edge_ids = np.lexsort((ranks[:, 0], ranks[:, 1]))
        self._lower = ranks[self._edge_ids, 0]
        lengths = np.bincount(ranks[:, 1], minlength=len(order))
        self._pointers = np.concatenate([[0], np.cumsum(lengths)])
        self._parents, self._starts = factor_pattern(self._pointers, self._lower)
        self._rows = np.empty(self._starts[-1], dtype=np.int64)
        self._blocks = np.empty((self._starts[-1], 4))
        self._inverses = np.empty((len(order), 4))

    def factorise(self, between: Float[np.ndarray, "e 2"], own: Float[np.ndarray, "m 3"]) -> None:
        """Factorise a positive definite matrix.

        Parameters
        ----------
        between
            (e, 2) its entries along each edge, of the first unknowns and of the second ones.
        own
            (m, 3) each vertex's block: first with first, first with second, second with second.
        """
        factorise(
            self._pointers,
            self._lower,
            between[self._edge_ids],
            own[self._order],
            self._parents,
            self._starts,
            self._rows,
            self._blocks,
            self._inverses,
        )

    def solve(self, right: Float[np.ndarray, "m 2 c"]) -> Float[np.ndarray, "m 2 c"]:
        """X for c right-hand sides."""
        permuted = right[self._order]
        solve_factorised(self._starts, self._rows, self._blocks, self._inverses, permuted)
        result = np.empty_like(permuted)
        result[self._order] = permuted
        return result
