"""Fields of distances on a lattice, whose levels are cloth: hung, bridged, folded, cut, meshed."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy.ndimage import binary_fill_holes, gaussian_filter, map_coordinates
from scipy.spatial import cKDTree
from skimage.measure import marching_cubes

from fitter.arrays import Normals, Vertices
from tests.accuracy.garment_samples import SkinSamples
from tests.accuracy.looks import CLOTH_ROUGHNESS
from tests.accuracy.meshes import PersonMesh
from tests.accuracy.noise import smooth_step, value_noise
from tests.accuracy.scene import Cloth, Label, Pattern

REPEAT_M = 0.07
"""Distance from one stripe to the next."""

WEAVE = 0.06

VOXEL_M = 0.01
MARGIN_M = 0.13
REACH_M = 0.14
"""Distances matter no farther than this."""

BRIDGE_M = 0.014
"""Deviation of the field's smoothing: hollows narrower than twice this are bridged."""

BARE_CLEARANCE_M = 0.009
"""Nor to bare forearms and hands before it."""

Field = Float[np.ndarray, "x y z"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Lattice:
    """Places ``origin`` + index * VOXEL_M, world; y is the second axis.

    ``within`` (k,) is the part of the body a place lies in, skin-deep, else -1; ``away`` (k,) its
    distance from the skin, ``REACH_M`` at most.
    """

    origin: Float[np.ndarray, "3"]
    shape: tuple[int, int, int]
    within: Integer[np.ndarray, " k"]
    away: Float[np.ndarray, " k"]

    def points(self) -> Float[np.ndarray, "k 3"]:
        return _places(self.origin, self.shape)

    def heights(self) -> Float[np.ndarray, " y"]:
        return self.origin[1] + VOXEL_M * np.arange(self.shape[1])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sheet:
    """A garment or a part of one.

    ``field`` is zero on the cloth, ``skin`` the distance to what it covers, ``cut`` is negative
    where the garment has the cloth.
    """

    field: Field
    skin: Field
    cut: Field


def sheet_of(
    lattice: Lattice,
    field: Float[np.ndarray, "..."],
    skin: Float[np.ndarray, " k"],
    cut: Float[np.ndarray, " k"],
) -> Sheet:
    """A sheet from its values place by place."""
    return Sheet(
        field=field.reshape(lattice.shape),
        skin=skin.reshape(lattice.shape),
        cut=cut.reshape(lattice.shape),
    )


def lattice_round(samples: SkinSamples, points: Vertices, *, lowest: float) -> Lattice:
    """Round points of the body, down to a height and no farther."""
    low, high = points.min(axis=0) - MARGIN_M, points.max(axis=0) + MARGIN_M
    low[1] = max(low[1], lowest - 0.05)
    x, y, z = np.ceil((high - low) / VOXEL_M).astype(int) + 1
    shape = (int(x), int(y), int(z))
    places = _places(low, shape)
    away, nearest = _nearest(places, samples.points)
    behind = np.einsum("ki,ki->k", places - samples.points[nearest], samples.normals[nearest])
    skin_deep = (away < REACH_M) & (behind < 0.0)
    within = np.where(skin_deep, samples.parts[nearest], -1)
    return Lattice(origin=low, shape=shape, within=within, away=away)


def _places(origin: Float[np.ndarray, "3"], shape: tuple[int, int, int]) -> Vertices:
    index = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
    return origin + VOXEL_M * index.reshape(-1, 3)


def skin_distance(
    lattice: Lattice, group: SkinSamples
) -> tuple[Float[np.ndarray, " k"], np.ndarray]:
    """Distance to a group's skin, ``REACH_M`` at most, and the index of its nearest sample.

    Negative within the group's own share of the body; a group alone has holes where limbs leave it.
    """
    points = lattice.points()
    shell = np.isin(lattice.within, np.unique(group.parts))
    inside = binary_fill_holes(shell.reshape(lattice.shape)).ravel()
    to_group, nearest_of_group = np.full(len(points), REACH_M), np.full(len(points), -1)
    near = lattice.away < REACH_M
    to_group[near], nearest_of_group[near] = _nearest(points[near], group.points)
    away = np.minimum(np.where(inside, lattice.away, np.inf), to_group)
    return np.where(inside, -away, away), nearest_of_group


def _nearest(points: Vertices, of: Vertices) -> tuple[Float[np.ndarray, " k"], np.ndarray]:
    away, nearest = cKDTree(of).query(points, eps=0.05, distance_upper_bound=REACH_M, workers=2)
    return np.minimum(away, REACH_M), np.minimum(nearest, len(of) - 1)


def hung(lattice: Lattice, field: Field, *, from_height: float, fall: float) -> Field:
    """Below a height the cloth goes on from what is above it, falling inward by ``fall``."""
    hung = field.copy()
    heights = lattice.heights()
    for row in range(len(heights) - 2, -1, -1):
        if heights[row] < from_height:
            hung[:, row] = np.minimum(hung[:, row], hung[:, row + 1] + fall * VOXEL_M)
    return hung


def cloth_mesh(
    lattice: Lattice,
    sheets: list[Sheet],
    bare: list[SkinSamples],
    cloth: Cloth,
    rng: np.random.Generator,
    *,
    top_height: float,
    clearance: float,
    label: Label,
) -> PersonMesh:
    """The union of closed sheets without the lids that their cuts put on them."""
    folds = _folds(lattice.points(), cloth, rng, top_height).reshape(lattice.shape)
    cuts = np.stack([sheet.cut for sheet in sheets])
    smooth = np.stack(
        [
            np.minimum(
                gaussian_filter(sheet.field, BRIDGE_M / VOXEL_M) + folds, sheet.skin - clearance
            )
            for sheet in sheets
        ]
    )
    closed = np.maximum(smooth, cuts)
    which = np.argmin(closed, axis=0)
    union = np.take_along_axis(closed, which[None], axis=0)[0]
    lid = np.take_along_axis(cuts - smooth, which[None], axis=0)[0]
    for part in bare:
        to_bare, _ = _nearest(lattice.points(), part.points)
        union = np.maximum(union, BARE_CLEARANCE_M - to_bare.reshape(lattice.shape))
    union = gaussian_filter(union, 0.6)
    corners, triangles, _, _ = marching_cubes(union, level=0.0)
    on_lid = map_coordinates(lid, corners.T, order=1) > 0.5 * VOXEL_M
    kept = ~on_lid[triangles].any(axis=1)
    vertices = lattice.origin + VOXEL_M * corners
    normals = _normals(gaussian_filter(union, 0.8), corners)
    return PersonMesh(
        vertices=vertices,
        normals=normals,
        triangles=triangles[kept],
        albedo=cloth_albedo(cloth, vertices, rng),
        roughness=np.full(len(vertices), CLOTH_ROUGHNESS),
        labels=np.full(len(vertices), label),
    )


def _folds(
    points: Vertices, cloth: Cloth, rng: np.random.Generator, top_height: float
) -> Float[np.ndarray, " k"]:
    """Long folds that grow downward, and small creases everywhere."""
    growing = smooth_step(top_height - points[:, 1], 0.05, 0.5)
    long = value_noise(rng, points / np.array([0.09, 0.5, 0.09]), octaves=2)
    small = value_noise(rng, points / np.array([0.07, 0.05, 0.07]), octaves=2)
    return cloth.fold_m * (growing * long + 0.25 * small)


def _normals(field: Field, corners: Float[np.ndarray, "k 3"]) -> Normals:
    slopes = np.stack(
        [map_coordinates(slope, corners.T, order=1) for slope in np.gradient(field)], axis=1
    )
    return slopes / np.maximum(np.linalg.norm(slopes, axis=1, keepdims=True), 1e-12)


def cloth_albedo(
    cloth: Cloth, points: Vertices, rng: np.random.Generator
) -> Float[np.ndarray, "k 3"]:
    """Linear albedo at points of the cloth, world."""
    first, second = np.array(cloth.colour), np.array(cloth.second_colour)
    weave = 1.0 + WEAVE * value_noise(rng, points / 0.02)
    wavering = points + 0.004 * value_noise(rng, points / 0.2)[:, None]
    share = np.zeros(len(points))
    if cloth.pattern is not Pattern.PLAIN:
        share = _band(wavering[:, 1])
    if cloth.pattern is Pattern.CHECKS:
        share = 0.5 * (share + _band(wavering[:, 0]))
    albedo = first + share[:, None] * (second - first)
    return np.clip(albedo * weave[:, None], 0.003, 0.9)


def _band(along: Float[np.ndarray, " k"]) -> Float[np.ndarray, " k"]:
    return smooth_step(np.sin(2.0 * np.pi * along / REPEAT_M), -0.15, 0.15)
