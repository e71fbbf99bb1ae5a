"""Inter-penetration penalty E_Pn: parts of the body must not run into one another.

Each part is filled with spheres attached to rings of its own vertices, so centres and radii follow
shape and pose; on the mean body each is the largest about its centre that fits inside the skin. Two
spheres of parts that are not neighbours cost the square of their overlap.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Integer
from scipy.spatial import KDTree

from fitter.arrays import Vertices
from fitter.body.model import BodyModel, SparseRows
from fitter.energies._body_kernels import pair_overlaps, ring_spheres, squared_overlaps
from fitter.energies.rows import PositionRows, Support
from fitter.energies.scales import EnergyScales
from fitter.numerics.meshes import vertex_areas

_LEAST_RING = 6
_SLICES_PER_THICKNESS = 4.0
# A slice this much longer than wide gets a sphere on either side of the middle one.
_SIDES_RATIO = 1.2
# A sphere with a smaller filling than this lies outside the body.
_LEAST_FILLING = 0.3
_UPRIGHT = ("pelvis", "spine", "chest", "neck", "head")
_SIDEWAYS, _UP, _FORWARD = np.eye(3)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PenetrationProxy:
    """Spheres and the pairs of them that must not overlap.

    Attributes
    ----------
    centres
        s rows over the vertices; a centre is the mean of its ring, weighted by area of skin.
    fillings
        (s,) radii divided by the mean distance of the rings from their centres.
    pairs
        (q, 2) sphere indices.
    """

    centres: SparseRows
    fillings: Float[np.ndarray, " s"]
    pairs: Integer[np.ndarray, "q 2"]


def penetration_proxy(model: BodyModel, canonical_vertices: Vertices) -> PenetrationProxy:
    """Fill a model's parts with spheres.

    Pairs that overlap in the canonical pose, where nothing penetrates, are left out.
    """
    rings, owner = _rings(model)
    areas = vertex_areas(model.mean_vertices, model.triangles)
    centres = SparseRows(
        names=tuple(model.part_names[part] for part in owner),
        pointers=np.concatenate([[0], np.cumsum([len(ring) for ring in rings])]),
        indices=np.concatenate(rings),
        weights=np.concatenate([areas[ring] / areas[ring].sum() for ring in rings]),
    )
    fillings = _fillings(centres, canonical_vertices)
    held = fillings >= _LEAST_FILLING
    first, second = np.triu_indices(len(rings), k=1)
    apart = ~_neighbours(model)[owner[first], owner[second]] & held[first] & held[second]
    every = PenetrationProxy(
        centres=centres,
        fillings=fillings,
        pairs=np.stack([first[apart], second[apart]], axis=1),
    )
    overlaps = sphere_overlaps(*sphere_positions(every, canonical_vertices), every.pairs)
    return replace(every, pairs=every.pairs[overlaps <= 0.0])


def sphere_positions(
    proxy: PenetrationProxy, vertices: Vertices
) -> tuple[Float[np.ndarray, "s 3"], Float[np.ndarray, " s"]]:
    """Centres (frame of the vertices) and radii in metres, from the rings' current vertices."""
    centres = proxy.centres
    count = len(centres.pointers) - 1
    positions, radii = np.empty((count, 3)), np.empty(count)
    ring_spheres(
        vertices,
        centres.pointers,
        centres.indices,
        centres.weights,
        proxy.fillings,
        positions,
        radii,
    )
    return positions, radii


def sphere_overlaps(
    spheres: Float[np.ndarray, "s 3"],
    radii: Float[np.ndarray, " s"],
    pairs: Integer[np.ndarray, "q 2"],
) -> Float[np.ndarray, " q"]:
    """Depth by which the spheres of each pair overlap, metres; negative if they are apart."""
    result = np.empty(len(pairs))
    pair_overlaps(spheres, radii, pairs, result)
    return result


def penetration_energy(
    spheres: Float[np.ndarray, "s 3"],
    radii: Float[np.ndarray, " s"],
    proxy: PenetrationProxy,
    scales: EnergyScales,
) -> float:
    """Half the sum of squared overlaps over σ²."""
    total = squared_overlaps(spheres, radii, proxy.pairs)
    return 0.5 * float(total) / scales.penetration_sigma_m**2


def penetration_rows(
    spheres: Float[np.ndarray, "s 3"],
    radii: Float[np.ndarray, " s"],
    proxy: PenetrationProxy,
    scales: EnergyScales,
) -> PositionRows:
    """One row per overlapping pair; points index the spheres, radii are held fixed."""
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
        support=Support.SPHERES,
    )


def _fillings(centres: SparseRows, vertices: Vertices) -> Float[np.ndarray, " s"]:
    """Radius at which each sphere touches the nearest skin, over its ring's mean distance."""
    count = len(centres.pointers) - 1
    unfilled = PenetrationProxy(
        centres=centres, fillings=np.ones(count), pairs=np.zeros((0, 2), dtype=np.int64)
    )
    positions, distances = sphere_positions(unfilled, vertices)
    nearest, _ = KDTree(vertices).query(positions)
    return np.minimum(nearest / distances, 1.0)


def _rings(model: BodyModel) -> tuple[list[np.ndarray], Integer[np.ndarray, " s"]]:
    """The rings of all parts, and the part of each."""
    dominant = model.skinning_parts[
        np.arange(len(model.mean_vertices)), np.argmax(model.skinning_weights, axis=1)
    ]
    rings: list[np.ndarray] = []
    owner: list[int] = []
    for part, name in enumerate(model.part_names):
        members = np.flatnonzero(dominant == part)
        found = _rings_of_part(model.mean_vertices, members, upright=name in _UPRIGHT)
        rings += found
        owner += [part] * len(found)
    return rings, np.array(owner)


def _rings_of_part(
    vertices: Vertices, members: Integer[np.ndarray, " k"], *, upright: bool
) -> list[np.ndarray]:
    """Cut a part's vertices into slices along its axis, and wide slices also into halves."""
    if len(members) < _LEAST_RING:
        return []
    points = vertices[members] - vertices[members].mean(axis=0)
    if upright:
        axes = np.stack([_UP, _SIDEWAYS, _FORWARD])
    else:
        _, _, axes = np.linalg.svd(points, full_matrices=False)
    along, across, deep = (points @ axis for axis in axes)
    thickness = max(min(np.ptp(across), np.ptp(deep)), 1e-6)
    slices = max(1, round(_SLICES_PER_THICKNESS * np.ptp(along) / thickness))
    bounds = np.linspace(along.min(), along.max(), slices + 1)
    index = np.clip(np.digitize(along, bounds) - 1, 0, slices - 1)
    rings: list[np.ndarray] = []
    for cut in range(slices):
        inside = index == cut
        groups = [inside]
        for one, other in ((across, deep), (deep, across)):
            if inside.any() and np.ptp(one[inside]) > _SIDES_RATIO * np.ptp(other[inside]):
                middle = 0.5 * (one[inside].min() + one[inside].max())
                groups += [inside & (one < middle), inside & (one >= middle)]
        rings.extend(members[group] for group in groups if np.count_nonzero(group) >= _LEAST_RING)
    return rings


def _neighbours(model: BodyModel) -> np.ndarray:
    """(p, p) bool: the same part, or connected by a joint, or through one part in between."""
    count = len(model.part_names)
    joined = np.eye(count, dtype=bool)
    for part, parent in enumerate(model.part_parent):
        if parent >= 0:
            joined[part, parent] = joined[parent, part] = True
    siblings = np.equal.outer(model.part_parent, model.part_parent)
    limbs = np.array(["thigh" in name or "arm" in name for name in model.part_names])
    # The thighs are siblings, but they can collide; so can the upper arms.
    siblings &= ~(limbs[:, None] & limbs[None, :])
    return joined | siblings
