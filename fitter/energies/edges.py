"""Edge energy E_Eg (section 3.3): the visible model edges integrated over the edge cost map.

The map is a thresholded distance transform of the picture's edges, in [0, 1].
"""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage, Image, Mask, PerVertex, Points2D
from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales
from fitter.observation.maps import sample
from fitter.render.contours import ModelEdges
from fitter.render.rasterizer import Rendering

# Canny's thresholds on 8-bit grey after smoothing; its author advises a ratio of 2 to 3. Low enough
# to see an arm in front of the trunk, skin against skin.
_CANNY_LOW, _CANNY_HIGH = 25.0, 70.0
_SMOOTHING_PX = 1.2


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EdgeCostMap:
    """Cost of a model edge at each pixel: 0 on an image edge, 1 beyond the threshold."""

    cost: GreyImage

    def at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Cost at continuous pixels."""
        return sample(self.cost, points)[0]

    def with_gradient_at(self, points: Points2D) -> tuple[Float[np.ndarray, " k"], Points2D]:
        """Cost and its derivative per pixel."""
        return sample(self.cost, points)

    def without(self, region: Mask) -> "EdgeCostMap":
        """The same with no image edge in a region (h, w)."""
        return EdgeCostMap(cost=np.where(region, np.float32(1.0), self.cost))


def edge_cost_map(display: Image, *, threshold_px: float) -> EdgeCostMap:
    """Distance to Canny edges of the picture's display values, truncated at ``threshold_px``.

    Parameters
    ----------
    display
        (h, w, 3) display-encoded values in [0, 1]: edges are sought as people see them.
    threshold_px
        Distance at which an edge no longer attracts.
    """
    grey = cv2.cvtColor(np.ascontiguousarray(display, dtype=np.float32), cv2.COLOR_RGB2GRAY)
    smooth = cv2.GaussianBlur(grey, (0, 0), _SMOOTHING_PX)
    levels = np.round(smooth * 255.0).clip(0, 255).astype(np.uint8)
    edges = cv2.Canny(levels, _CANNY_LOW, _CANNY_HIGH, L2gradient=True)
    # The 5 x 5 mask is off by 2 % and takes a quarter of the time; past the threshold all is 1.
    distance = cv2.distanceTransform((edges == 0).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return EdgeCostMap(cost=(np.minimum(distance, threshold_px) / threshold_px).astype(np.float32))


# The cost is linear in the distance to an image edge; bounds its least-squares weight, 1/cost.
_LEAST_COST = 0.05
# Edges seen end-on have no length to average over.
_LEAST_LENGTH_PX = 1.0


def edge_energy(
    edges: ModelEdges, cost: EdgeCostMap, scales: EnergyScales, bare: PerVertex | None = None
) -> float:
    """E_Eg in nats: mean cost along the visible model edges, by the trapezoid rule.

    The mean, not the integral: a body must not gain by showing fewer edges. Edges under loose
    clothes, where ``bare`` is low, may be anywhere: the picture shows those of the clothes.
    """
    ends = edges.endpoints[edges.visible]
    if not len(ends):
        return scales.edge_weight
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    values = cost.at(ends.reshape(-1, 2)).reshape(-1, 2)
    if bare is not None:
        values = values * bare[edges.edges[edges.visible]]
    integral = float((lengths * values.mean(axis=1)).sum())
    return scales.edge_weight * integral / max(float(lengths.sum()), _LEAST_LENGTH_PX)


def edge_rows(
    rendering: Rendering,
    edges: ModelEdges,
    cost: EdgeCostMap,
    scales: EnergyScales,
    bare: PerVertex | None = None,
) -> PositionRows:
    """One row for each end of each visible edge; the residual is the cost there."""
    pairs = edges.edges[edges.visible]
    ends = edges.endpoints[edges.visible]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    points = pairs.reshape(-1)
    values, slopes = cost.with_gradient_at(ends.reshape(-1, 2))
    share = (
        scales.edge_weight
        * 0.5
        * np.repeat(lengths, 2)
        / max(float(lengths.sum()), _LEAST_LENGTH_PX)
    )
    if bare is not None:
        share = share * bare[points]
    return PositionRows(
        residuals=values,
        weights=share / np.maximum(values, _LEAST_COST),
        points=points[:, None],
        derivatives=rendering.camera.pull_back(rendering.vertices[points], slopes)[:, None],
    )
