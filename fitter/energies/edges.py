"""Edge energy E_Eg (section 3.3): the visible model edges integrated over the edge cost map."""

import numpy as np

from fitter.arrays import PerVertex
from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales
from fitter.evidence.edge_cost import EdgeCostMap
from fitter.render.contours import ModelEdges
from fitter.render.rasterizer import Rendering

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
