"""The graph that GrabCut cuts: open pixels are nodes, linked to their neighbours.

Known pixels are not nodes. A known pixel always stays on its own side, so its link to an open
neighbour is equivalent to a link from that neighbour to the known pixel's terminal (Boykov and
Jolly 2001). The band is a tenth to a third of the picture, and time grows with the nodes.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int, UInt8

from fitter.arrays import Mask
from fitter.segmentation._band_kernels import link_band, mean_squared_difference
from fitter.segmentation._max_flow_kernels import SOURCE, maximum_flow, push_to_neighbours

SMOOTHNESS = 50.0
"""GrabCut's gamma: the cost of a border between two pixels of the same colour, nats."""

STEPS_PER_NAT = 1000
"""Capacities are integers, so that sums are exact and saturated arcs exactly full."""

CERTAIN = 9.0 * SMOOTHNESS
"""A pixel's eight links together weigh at most 4 (1 + 1/sqrt(2)) gamma, so the cut does not change
once the difference between the pixel's two costs exceeds this."""


@dataclass(slots=True, eq=False, kw_only=True)
class BandGraph:
    """The residual graph after the flow so far. Mutable: cutting changes it.

    Attributes
    ----------
    heads, capacities
        (8 n,) see the kernels.
    bound
        (n,) links through known neighbours to the source, minus those to the sink.
    given, left
        (n,) preference for the source at the last cut, and what the flow left of it.
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
        """Link the open pixels of a picture; ``foreground`` gives the sides of the others.

        Two neighbours p and q are linked with weight gamma exp(-beta |z_p - z_q|²) / dist(p, q),
        where beta is the inverse of twice the mean of |z_p - z_q|² over the picture.
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

        Only terminals change from cut to cut, so the previous flow is reused: the change is added
        to their residuals (Kohli and Torr 2005, section 3).

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
    """Capacity of a straight link by the squared difference, up to where it rounds to zero."""
    full = STEPS_PER_NAT * SMOOTHNESS
    beta = 0.5 / max(mean_square, np.finfo(np.float64).tiny)
    end = min(int(np.log(2.0 * full) / beta) + 1, 3 * 255**2 + 1)
    return np.rint(full * np.exp(-beta * np.arange(end))).astype(np.int32)
