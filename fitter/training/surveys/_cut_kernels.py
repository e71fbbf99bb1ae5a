"""Which triangles a plane cuts, asked for every girth of every trial of a subject's search."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True)
def crossed_triangles(side, triangles):
    """Triangles with corners on both sides; a corner at zero counts as above."""
    found = np.empty(len(triangles), np.int64)
    count = 0
    for triangle in range(len(triangles)):
        first, second, third = triangles[triangle]
        above = side[first] >= 0.0
        if (side[second] >= 0.0) != above or (side[third] >= 0.0) != above:
            found[count] = triangle
            count += 1
    return found[:count]
