"""Fields of distances from samples of the skin, whose levels are cloth: hung, cut, meshed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy.ndimage import binary_fill_holes, gaussian_filter, map_coordinates
from scipy.spatial import cKDTree
from skimage.measure import marching_cubes

from fitter.arrays import Normals, Vertices
from tests.accuracy.landmark_points import packaged_model, rest_landmarks
from tests.accuracy.looks import CLOTH_ROUGHNESS
from tests.accuracy.meshes import PersonMesh, vertex_normals
from tests.accuracy.noise import smooth_step, value_noise
from tests.accuracy.people import rig_of_people
from tests.accuracy.scene import Cloth, Label, Pattern
from tests.accuracy.staging import Staged

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

ARM_PARTS = ("upper_arm", "forearm", "hand")
LEG_PARTS = tuple(
    f"{side}_{part}" for side in ("left", "right") for part in ("thigh", "shin", "foot")
)

SPACING_M = 0.009


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SkinSamples:
    """``points`` and ``normals`` (s, 3) in the world, ``rest`` (s, 3) at rest, ``parts`` (s,)."""

    points: Vertices
    normals: Normals
    rest: Vertices
    parts: Integer[np.ndarray, " s"]
    part_names: tuple[str, ...]
    arm_ends: dict[str, tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]]

    def is_part(self, name: str) -> Bool[np.ndarray, " s"]:
        """Which samples belong to a part."""
        return self.parts == self.part_names.index(name)

    def of(self, names: Sequence[str]) -> "SkinSamples":
        """The samples of some parts."""
        return self.chosen(np.isin(self.parts, [self.part_names.index(name) for name in names]))

    def chosen(self, chosen: Bool[np.ndarray, " s"]) -> "SkinSamples":
        """Some of the samples."""
        return SkinSamples(
            points=self.points[chosen],
            normals=self.normals[chosen],
            rest=self.rest[chosen],
            parts=self.parts[chosen],
            part_names=self.part_names,
            arm_ends=self.arm_ends,
        )

    def along_arm(self, samples: "SkinSamples", side: str) -> Float[np.ndarray, " s"]:
        """0 at the shoulder, 1 at the wrist, at rest."""
        shoulder, wrist = self.arm_ends[side]
        arm = wrist - shoulder
        return (samples.rest - shoulder) @ arm / (arm @ arm)


def skin_samples(staged: Staged) -> SkinSamples:
    """Sample the posed body's triangles evenly."""
    model = packaged_model(staged.person.gender)
    triangles = rig_of_people().surface.triangles
    rest = rig_of_people().surface.body(staged.person.source_vertices)
    normals = vertex_normals(staged.body, triangles)
    first, second, third = (staged.body[triangles[:, k]] for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(second - first, third - first), axis=1)
    counts = np.maximum(np.ceil(areas / SPACING_M**2).astype(int), 1)
    owners = np.repeat(np.arange(len(triangles)), counts)
    number = np.arange(len(owners)) - np.repeat(np.cumsum(counts) - counts, counts)
    # Kronecker's sequence of the plastic number spreads points evenly over each triangle.
    u, v = (number * 0.7548776662466927 + 0.5) % 1.0, (number * 0.5698402909980532 + 0.5) % 1.0
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    shares = np.stack([1.0 - u - v, u, v], axis=1)[:, :, None]

    def spread(values: Vertices) -> Vertices:
        return (shares * values[triangles[owners]]).sum(axis=1)

    directions = spread(normals)
    marks = rest_landmarks(staged.person)
    return SkinSamples(
        points=spread(staged.body),
        normals=directions / np.linalg.norm(directions, axis=1, keepdims=True),
        rest=spread(rest),
        parts=model.part_of_triangle[owners],
        part_names=model.part_names,
        arm_ends={
            side: (marks[f"{side}_shoulder"], marks[f"{side}_wrist"]) for side in ("left", "right")
        },
    )


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
