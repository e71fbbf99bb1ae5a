"""Inter-penetration penalty E_Pn: parts of the body do not run into one another.

Each part is filled with spheres hung on rings of its own vertices, so centres and radii follow
shape and pose. Two spheres of parts that are not neighbours cost the square of their overlap.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points3D, Vertices
from fitter.body.model import BodyModel, SparseRows
from fitter.energies._sphere_kernels import pair_overlaps, ring_spheres
from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales

_LEAST_RING = 6
# Spheres stay inside the skin, which yields where parts touch.
_FILLING = 0.9
# A part as wide as this against its depth is split sideways: trunks are not round.
_SPLIT_RATIO = 1.3
_SLICES_PER_WIDTH = 2.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PenetrationProxy:
    """Spheres and the pairs of them that must not overlap.

    Attributes
    ----------
    centres
        s rows over the vertices; a centre is the mean of its ring.
    pairs
        (q, 2) sphere indices.
    """

    centres: SparseRows
    pairs: Integer[np.ndarray, "q 2"]


def penetration_proxy(model: BodyModel, canonical_vertices: Vertices) -> PenetrationProxy:
    """Fill a model's parts with spheres.

    Pairs that overlap in the canonical pose, where nothing penetrates, are left out.
    """
    rings: list[np.ndarray] = []
    parts: list[int] = []
    dominant = model.skinning_parts[
        np.arange(len(model.mean_vertices)), np.argmax(model.skinning_weights, axis=1)
    ]
    for part in range(len(model.part_names)):
        for ring in _rings_of_part(model.mean_vertices, np.flatnonzero(dominant == part)):
            rings.append(ring)
            parts.append(part)
    centres = SparseRows(
        names=tuple(model.part_names[part] for part in parts),
        pointers=np.concatenate([[0], np.cumsum([len(ring) for ring in rings])]),
        indices=np.concatenate(rings),
        weights=np.concatenate([np.full(len(ring), 1.0 / len(ring)) for ring in rings]),
    )
    owner = np.array(parts)
    first, second = np.triu_indices(len(rings), k=1)
    apart = ~_neighbours(model)[owner[first], owner[second]]
    pairs = np.stack([first[apart], second[apart]], axis=1)
    spheres, radii = sphere_positions(centres, canonical_vertices)
    overlap = sphere_overlaps(spheres, radii, pairs)
    return PenetrationProxy(centres=centres, pairs=pairs[overlap <= 0.0])


def sphere_positions(
    centres: SparseRows, vertices: Vertices
) -> tuple[Points3D, Float[np.ndarray, " s"]]:
    """Centres (frame of the vertices) and radii in metres, from the rings' present vertices."""
    count = len(centres.pointers) - 1
    positions, radii = np.empty((count, 3)), np.empty(count)
    ring_spheres(
        vertices, centres.pointers, centres.indices, centres.weights, _FILLING, positions, radii
    )
    return positions, radii


def sphere_overlaps(
    spheres: Points3D, radii: Float[np.ndarray, " s"], pairs: Integer[np.ndarray, "q 2"]
) -> Float[np.ndarray, " q"]:
    """Depth by which the spheres of each pair overlap, metres; negative where they are apart."""
    result = np.empty(len(pairs))
    pair_overlaps(spheres, radii, pairs, result)
    return result


def penetration_energy(
    spheres: Points3D,
    radii: Float[np.ndarray, " s"],
    proxy: PenetrationProxy,
    scales: EnergyScales,
) -> float:
    """Half the sum of squared overlaps over σ²."""
    overlap = np.maximum(sphere_overlaps(spheres, radii, proxy.pairs), 0.0)
    return 0.5 * float((overlap**2).sum()) / scales.penetration_sigma_m**2


def penetration_rows(
    spheres: Points3D,
    radii: Float[np.ndarray, " s"],
    proxy: PenetrationProxy,
    scales: EnergyScales,
) -> PositionRows:
    """One row for each overlapping pair; points index the spheres, radii are held."""
    overlap = sphere_overlaps(spheres, radii, proxy.pairs)
    pairs = proxy.pairs[overlap > 0.0]
    between = spheres[pairs[:, 0]] - spheres[pairs[:, 1]]
    distance = np.maximum(np.linalg.norm(between, axis=1, keepdims=True), 1e-9)
    apart = between / distance
    return PositionRows(
        residuals=overlap[overlap > 0.0],
        weights=np.full(len(pairs), 1.0 / scales.penetration_sigma_m**2),
        points=pairs,
        derivatives=np.stack([-apart, apart], axis=1),
    )


def _rings_of_part(vertices: Vertices, members: Integer[np.ndarray, " k"]) -> list[np.ndarray]:
    """Cut a part's vertices into slices along its long axis, wide slices into halves."""
    if len(members) < _LEAST_RING:
        return []
    points = vertices[members] - vertices[members].mean(axis=0)
    _, _, axes = np.linalg.svd(points, full_matrices=False)
    along, across, deep = (points @ axis for axis in axes)
    length, width, depth = (float(np.ptp(values)) for values in (along, across, deep))
    slices = max(1, round(_SLICES_PER_WIDTH * length / max(depth, 1e-6)))
    bounds = np.linspace(along.min(), along.max(), slices + 1)
    index = np.clip(np.digitize(along, bounds) - 1, 0, slices - 1)
    rings: list[np.ndarray] = []
    halves = 2 if width > _SPLIT_RATIO * depth else 1
    for cut in range(slices):
        inside = index == cut
        sides = [inside] if halves == 1 else [inside & (across < 0), inside & (across >= 0)]
        rings.extend(members[side] for side in sides if np.count_nonzero(side) >= _LEAST_RING)
    return rings


def _neighbours(model: BodyModel) -> np.ndarray:
    """(p, p) bool: the same part, or joined by a joint, or through one part between them."""
    count = len(model.part_names)
    joined = np.eye(count, dtype=bool)
    for part, parent in enumerate(model.part_parent):
        if parent >= 0:
            joined[part, parent] = joined[parent, part] = True
    siblings = np.equal.outer(model.part_parent, model.part_parent)
    limbs = np.array(["thigh" in name or "arm" in name for name in model.part_names])
    # Thighs are siblings that can collide; so can upper arms.
    siblings &= ~(limbs[:, None] & limbs[None, :])
    return joined | siblings
