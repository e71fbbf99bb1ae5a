"""Reflectance of hidden vertices: continued as smoothly as possible from the visible ones.

Eq. 2 asks nothing of a hidden vertex but to be like its neighbours, so hidden vertices can be left
out of the search for the others' reflectance; they are filled in once, at the end.
"""

from dataclasses import dataclass

import numpy as np
import qdldl
from jaxtyping import Bool, Float, Integer
from scipy import sparse

from fitter.arrays import Image, PerVertex, Vertices
from fitter.energies.objective import Candidate
from fitter.energies.shading import IntensityMap, seen_vertices
from fitter.observation.maps import sample

# Ties components without any known vertex to the mean of the known values.
_RIDGE = 1e-6


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HiddenVertices:
    """The smoothest continuation onto some vertices, ready for any field.

    Attributes
    ----------
    known, unknown
        (m,) which vertices keep their values, and (u,) the ids of the others.
    border
        (u, m) stiffness of the edges from unknown vertices to known ones.
    ridges
        (u,) how strongly each is drawn toward a value that does not depend on its neighbours.
    solver
        Solves with the unknown vertices' own matrix; None if there are none.
    """

    known: Bool[np.ndarray, " m"]
    unknown: Integer[np.ndarray, " u"]
    border: sparse.csr_array
    ridges: Float[np.ndarray, " u"]
    solver: qdldl.Solver | None

    @classmethod
    def of(
        cls,
        known: Bool[np.ndarray, " m"],
        edges: Integer[np.ndarray, "e 2"],
        edge_lengths: Float[np.ndarray, " e"],
        *,
        ridge: float | PerVertex = _RIDGE,
    ) -> "HiddenVertices":
        """Factorise Σ (v_i - v_j)² / d_ij over the edges and their lengths d, plus Σ ridge_i v_i².

        Parameters
        ----------
        known
            Which vertices keep their values; at least one.
        ridge
            How strongly every unknown vertex is drawn toward a value of its own.
        """
        unknown = np.flatnonzero(~known)
        ridges = np.broadcast_to(ridge, known.shape)[unknown]
        count = len(unknown)
        place = np.full(len(known), -1)
        place[unknown] = np.arange(count)
        # Every edge, as seen from both of its ends.
        here, there = np.concatenate([edges, edges[:, ::-1]]).T
        stiffness = np.concatenate([1.0 / edge_lengths] * 2)
        of_unknown = ~known[here]
        here, there, stiffness = place[here[of_unknown]], there[of_unknown], stiffness[of_unknown]
        given = known[there]
        border = sparse.coo_array(
            (stiffness[given], (here[given], there[given])), shape=(count, len(known))
        )
        upper = here < place[there]
        diagonal = ridges + np.bincount(here, stiffness, count)
        matrix = sparse.coo_array(
            (
                np.concatenate([diagonal, -stiffness[upper]]),
                (
                    np.concatenate([np.arange(count), here[upper]]),
                    np.concatenate([np.arange(count), place[there[upper]]]),
                ),
            ),
            shape=(count, count),
        )
        return cls(
            known=known,
            unknown=unknown,
            border=border.tocsr(),
            ridges=ridges,
            solver=qdldl.Solver(sparse.csc_matrix(matrix), upper=True) if count else None,
        )

    def filled(self, values: PerVertex, *, toward: float | None = None) -> PerVertex:
        """The values (m,) with the unknown ones filled in.

        They are drawn toward the known ones' mean, or toward a value that is given.
        """
        if self.solver is None:
            return values.copy()
        kept = np.where(self.known, values, 0.0)
        rest = values[self.known].mean() if toward is None else toward
        pull = self.border @ kept + self.ridges * rest
        kept[self.unknown] = self.solver.solve(pull)
        return kept


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
