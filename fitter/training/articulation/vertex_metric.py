"""What an error of a part's right-hand side does to the vertices.

The mesh is Y = L⁻¹ Σ_p S_p b_p, where S_p scatters the right-hand side b_p of part p. An error e of
b_p moves the vertices by L⁻¹ S_p e, so its mean square there is |F_p e|² with F_p = L⁻¹ S_p / √m.
Smooth errors, which add up along a limb, weigh thousands of times more than rough ones.
"""

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.sparse.linalg import splu

from fitter.training.articulation.parts import Parts

STRIDE = 8
"""Every eighth vertex stands for its neighbours: what is smooth needs no more."""


def vertex_motions(
    laplacians: list[sparse.csr_array], parts: Parts
) -> list[Float[np.ndarray, "_ i"]]:
    """F_p of each part; the body's translation, which is free, does not count.

    Parameters
    ----------
    laplacians
        L_p = G_pᵀ W_p G_p of each part.
    parts
        Which vertices each part touches.
    """
    count = parts.incidence_vertices.max() + 1
    total = sum(laplacians[1:], start=laplacians[0])
    # Holding one vertex frees the matrix of its null space; right-hand sides sum to zero.
    held = sparse.coo_array(([total.diagonal().mean()], ([0], [0])), shape=(count, count))
    sample = np.arange(0, count, STRIDE)
    chosen = np.zeros((count, len(sample)))
    chosen[sample, np.arange(len(sample))] = 1.0
    rows = splu(sparse.csc_matrix(total + held)).solve(chosen).T
    rows -= rows.mean(axis=0)
    rows /= np.sqrt(len(sample))
    motions: list[np.ndarray] = []
    for part in range(len(laplacians)):
        span = slice(parts.incidence_pointers[part], parts.incidence_pointers[part + 1])
        motions.append(rows[:, parts.incidence_vertices[span]])
    return motions
