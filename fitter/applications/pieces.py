"""Pieces of what is seen of a body: connected parts of its surface that show one plain colour.

The piecewise constant functional of Mumford and Shah on a mesh, Σ area |c - mean|² plus a cost for
each metre of border, is made smaller by merging neighbours (Koepfler, Lopez and Morel, "A
multiscale algorithm for image segmentation by variational method", SIAM J. Numer. Anal. 1994).
Checks, folds and prints go, hems and broad stripes stay.
"""

from functools import lru_cache

import cv2
import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.applications.picture_surface import Colours
from fitter.applications.surface_field import edges_of
from fitter.body.model import BodyModel
from fitter.observation.pixels import display_from_linear

BRIGHTNESS_SHARE = 0.4
"""Weight of brightness against hue and saturation: folds and shade change brightness most."""

BORDER_COST = 8.0
"""Cost of a metre of border, in squares of CIELAB metres: a stripe of 3 cm stays if it differs by
23 from what is beside it, and one of 20 cm by 9."""

_BORDER_SHARE = 0.62
# Side of a regular hexagon against the root of its area: the border between two vertices.


def cloth_colours(colours: Colours) -> Colours:
    """CIELAB with less of its brightness."""
    shown = display_from_linear(np.clip(colours, 0.0, 1.0)).astype(np.float32)
    lab = cv2.cvtColor(shown[None], cv2.COLOR_RGB2LAB)[0].astype(np.float64)
    return lab * [BRIGHTNESS_SHARE, 1.0, 1.0]


@lru_cache(maxsize=2)
def vertex_areas(model: BodyModel) -> Float[np.ndarray, " m"]:
    """A third of the triangles round each vertex, square metres on the mean body."""
    first, second, third = model.mean_vertices[model.triangles].transpose(1, 0, 2)
    doubled = np.linalg.norm(np.cross(second - first, third - first), axis=1)
    corners, count = model.triangles.ravel(), len(model.mean_vertices)
    return np.bincount(corners, np.repeat(doubled / 6.0, 3), count)


def pieces_of(
    model: BodyModel, seen: Bool[np.ndarray, " m"], colours: Float[np.ndarray, "m 3"]
) -> Integer[np.ndarray, " m"]:
    """The piece of each vertex, by number; -1 for those that are not seen.

    Every two pieces merge that are each the other's cheapest neighbour, until none of them gain.

    Parameters
    ----------
    colours
        (m, 3) linear; of vertices that are not seen without meaning.
    """
    edges, areas = edges_of(model), vertex_areas(model)
    borders = _BORDER_SHARE * np.sqrt(areas[edges].mean(axis=1))
    inside = seen[edges].all(axis=1)
    edges, borders = edges[inside], borders[inside]
    piece = np.where(seen, np.cumsum(seen) - 1, -1)
    edges, areas, means = piece[edges], areas[seen], cloth_colours(colours[seen])
    while len(edges):
        first, second = edges.T
        apart = np.sum((means[first] - means[second]) ** 2, axis=1)
        # Growth of the spread for each metre of border that goes.
        costs = areas[first] * areas[second] / (areas[first] + areas[second]) * apart / borders
        # Ranks have no ties, which would leave nobody each other's cheapest.
        order = np.argsort(costs, kind="stable")
        rank = np.empty(len(order), dtype=np.intp)
        rank[order] = np.arange(len(order))
        cheapest = np.full(len(areas), len(order))
        np.minimum.at(cheapest, edges, rank[:, None])
        merging = (cheapest[first] == rank) & (cheapest[second] == rank) & (costs < BORDER_COST)
        if not merging.any():
            break
        into = np.arange(len(areas))
        into[second[merging]] = first[merging]
        into = np.unique(into, return_inverse=True)[1]
        totals = np.bincount(into, areas)
        means = np.stack([np.bincount(into, areas * each) for each in means.T], axis=1)
        means, areas = means / totals[:, None], totals
        piece = np.where(seen, into[piece], -1)
        edges, borders = _joined(into[edges], borders)
    return piece


def _joined(
    edges: Integer[np.ndarray, "e 2"], borders: Float[np.ndarray, " e"]
) -> tuple[Integer[np.ndarray, "b 2"], Float[np.ndarray, " b"]]:
    """Each pair of neighbours once, with all of their border."""
    low, high = np.sort(edges, axis=1).T
    apart = low != high
    count = int(edges.max()) + 1
    pairs, which = np.unique(low[apart] * count + high[apart], return_inverse=True)
    # Of nothing bincount counts whole numbers.
    lengths = np.bincount(which, borders[apart]).astype(np.float64)
    return np.stack([pairs // count, pairs % count], axis=1), lengths
