"""Rigid parts of the mesh, from skinning weights."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles

FOLLOWED_PARTS = 4
"""Parts whose motion a vertex may follow in the linear-blend tangent."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Parts:
    """The mesh cut into parts; fields as in :class:`fitter.body.model.BodyModel`."""

    part_of_triangle: Integer[np.ndarray, " f"]
    skinning_parts: Integer[np.ndarray, "m 4"]
    skinning_weights: Float[np.ndarray, "m 4"]
    incidence_pointers: Integer[np.ndarray, " p1"]
    incidence_vertices: Integer[np.ndarray, " i"]


def cut_into_parts(triangles: Triangles, weights: Float[np.ndarray, "m p"]) -> Parts:
    """Give each triangle to the part that its corners follow most.

    Parameters
    ----------
    triangles
        (f, 3).
    weights
        Skinning weights summed over the bones of each part, rows sum to one.
    """
    return joined_parts(triangles, np.argmax(weights[triangles].sum(axis=1), axis=1), weights)


def joined_parts(
    triangles: Triangles,
    part_of_triangle: Integer[np.ndarray, " f"],
    weights: Float[np.ndarray, "m p"],
) -> Parts:
    """The same where each triangle's part is given."""
    strongest = np.argsort(-weights, axis=1, kind="stable")[:, :FOLLOWED_PARTS]
    kept = np.take_along_axis(weights, strongest, axis=1)
    touched = [np.unique(triangles[part_of_triangle == part]) for part in range(weights.shape[1])]
    return Parts(
        part_of_triangle=part_of_triangle.astype(np.int32),
        skinning_parts=strongest.astype(np.int32),
        skinning_weights=kept / kept.sum(axis=1, keepdims=True),
        incidence_pointers=np.cumsum([0, *map(len, touched)]).astype(np.int32),
        incidence_vertices=np.concatenate(touched).astype(np.int32),
    )
