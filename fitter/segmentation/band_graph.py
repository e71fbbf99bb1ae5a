"""The graph GrabCut cuts: open pixels as nodes, and how strongly neighbours hold together.

A known pixel is no node. Its link to an open neighbour cannot be cut from its own side, so it is as
good as a link of that neighbour to the terminal the known pixel belongs to (Boykov and Jolly 2001).
The band is a tenth to a third of the picture, and the time goes with the nodes.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int, UInt8

from fitter.arrays import Mask
from fitter.segmentation._band_kernels import link_band, mean_squared_difference
from fitter.segmentation._max_flow_kernels import SOURCE, maximum_flow, push_to_neighbours

SMOOTHNESS = 50.0
"""GrabCut's gamma: the cost of a border between two pixels of one colour, nats."""

STEPS_PER_NAT = 1000
"""Capacities are whole numbers: sums are exact, and filled arcs exactly full."""

CERTAIN = 9.0 * SMOOTHNESS
"""No pixel's eight links together weigh more than 4 (1 + 1/sqrt(2)) gamma, so that beyond this
difference between the two costs of a pixel the cut stays the same."""


@dataclass(slots=True, eq=False, kw_only=True)
class BandGraph:
    """What the flow so far left of the capacities. Cutting changes it.

    Attributes
    ----------
    heads, capacities
        (8 n,) see the kernels.
    bound
        (n,) what known neighbours bind to the source, minus to the sink.
    given, left
        (n,) preference for the source the flow was last asked for, and what of it is left.
    """

    heads: Int[np.ndarray, " a"]
    capacities: Int[np.ndarray, " a"]
    bound: Int[np.ndarray, " n"]
    given: Int[np.ndarray, " n"]
    left: Int[np.ndarray, " n"]

    @classmethod
    def of(
        cls, picture: UInt8[np.ndarray, "h w 3"], open_pixels: Mask, foreground: Mask
    ) -> "BandGraph":
        """Link the open pixels of a picture; ``foreground`` tells the sides of the others.

        Two neighbours p and q hold together by gamma exp(-beta |z_p - z_q|²) / dist(p, q), with
        beta the inverse of twice the mean of |z_p - z_q|² over the picture.
        """
        rows, columns = (each.astype(np.int32) for each in np.nonzero(open_pixels))
        nodes = np.full(open_pixels.shape, -1, dtype=np.int32)
        nodes[open_pixels] = np.arange(len(rows), dtype=np.int32)
        straight = _capacity_table(mean_squared_difference(picture))
        diagonal = np.rint(straight / np.sqrt(2.0)).astype(np.int32)
        heads, capacities, bound = link_band(
            picture, foreground, nodes, rows, columns, straight, diagonal
        )
        none = np.zeros(len(rows), dtype=np.int32)
        return cls(heads=heads, capacities=capacities, bound=bound, given=none, left=none.copy())

    def cut(self, preference: Float[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
        """The open pixels on the foreground's side of the minimum cut.

        Only terminals change from cut to cut, so the flow found before stays: the change is added
        to what is left of them (Kohli and Torr 2005, section 3).

        Parameters
        ----------
        preference
            Cost of background minus cost of foreground, nats.
        """
        limited = np.clip(preference, -CERTAIN, CERTAIN)
        given = np.rint(STEPS_PER_NAT * limited).astype(np.int32) + self.bound
        self.left += given - self.given
        self.given = given
        push_to_neighbours(self.heads, self.capacities, self.left)
        return maximum_flow(self.heads, self.capacities, self.left) == SOURCE


def _capacity_table(mean_square: float) -> Int[np.ndarray, " d"]:
    """Capacity of a straight link by the squared difference, up to where it rounds to nothing."""
    full = STEPS_PER_NAT * SMOOTHNESS
    beta = 0.5 / max(mean_square, np.finfo(np.float64).tiny)
    end = min(int(np.log(2.0 * full) / beta) + 1, 3 * 255**2 + 1)
    return np.rint(full * np.exp(-beta * np.arange(end))).astype(np.int32)
