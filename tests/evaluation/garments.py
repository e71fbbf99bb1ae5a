"""Loose clothes over a posed body: surfaces of level of a field of distances.

A garment lies at a distance from the skin it covers, its ease; where the body tapers below, it
hangs on from what is above it; it bridges hollows, has folds, and ends at hem, cuff and neckline.
It is the level zero of a field on a lattice: distance less ease, smoothed, pulled down, roughened.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy.ndimage import binary_fill_holes, gaussian_filter, map_coordinates
from scipy.spatial import cKDTree
from skimage.measure import marching_cubes

from fitter.arrays import Normals, Vertices
from tests.evaluation.garment_cloth import cloth_albedo
from tests.evaluation.garment_samples import ARM_PARTS, LEG_PARTS, SkinSamples, skin_samples
from tests.evaluation.landmark_points import rest_landmarks
from tests.evaluation.looks import CLOTH_ROUGHNESS
from tests.evaluation.noise import smooth_step, value_noise
from tests.evaluation.person_mesh import PersonMesh
from tests.evaluation.scene import Bottom, Cloth, Label, Shoes, Top
from tests.evaluation.staging import Staged

VOXEL_M = 0.01
MARGIN_M = 0.13
REACH_M = 0.14
"""Distances matter no farther than this."""

BRIDGE_M = 0.014
"""Deviation of the field's smoothing: hollows narrower than twice this are bridged."""

CLEARANCE_M = 0.006
"""Shoes are no nearer to the skin."""

CUFF_M, CUFF_EASE_M, BLOUSING = 0.04, 0.006, 0.8
"""A ribbed cuff's breadth, how far it stands off, and how steeply cloth widens above it."""

SHOE_HEIGHT_M, SHOE_EASE_M = 0.075, 0.008
"""A low shoe's edge above the foot's sole."""

BARE_CLEARANCE_M = 0.009
"""Nor to bare forearms and hands before it."""

ARM_LENGTH_M = 0.55
"""About: turns shares of an arm into metres."""

NECK_DEPTH_M = 0.14
"""About: from the nape to the front of the neck's root."""

SIDES = ("left", "right")

Field = Float[np.ndarray, "x y z"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Lattice:
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
class _Sheet:
    """A garment or a part of one.

    ``field`` is zero on the cloth, ``skin`` the distance to what it covers, ``cut`` is negative
    where the garment has the cloth.
    """

    field: Field
    skin: Field
    cut: Field


def garment_meshes(staged: Staged, rng: np.random.Generator) -> list[PersonMesh]:
    """The outfit of a case as meshes in the world, none without one."""
    outfit = staged.case.outfit
    if outfit is None:
        return []
    samples = skin_samples(staged)
    meshes: list[PersonMesh] = []
    if outfit.top is not None:
        label = Label.LOWER if outfit.bottom is None else Label.UPPER
        meshes.append(_top(staged, samples, outfit.top, label, rng))
    if outfit.bottom is not None:
        over = outfit.bottom.waist if outfit.top is None else outfit.top.hem
        meshes.append(_bottom(staged, samples, outfit.bottom, over, rng))
    if outfit.jacket is not None:
        meshes.append(_top(staged, samples, outfit.jacket, Label.UPPER, rng))
    if outfit.shoes is not None:
        meshes += [_shoe(staged, samples, outfit.shoes, side, rng) for side in SIDES]
    return meshes


def _top(
    staged: Staged, samples: SkinSamples, top: Top, label: Label, rng: np.random.Generator
) -> PersonMesh:
    marks = rest_landmarks(staged.person)
    body = samples.of(("head", "neck", "chest", "spine", "pelvis", *LEG_PARTS))
    sleeves = samples.of(("left_upper_arm", "right_upper_arm", "left_forearm", "right_forearm"))
    hem = _floor(staged) + top.hem * _stature(samples)
    lattice = _lattice(samples, np.concatenate([body.points, sleeves.points]), lowest=hem)
    bust = 0.5 * (marks["left_nipple"] + marks["right_nipple"])[1]
    shoulder = marks["left_acromion"][1]
    distance, nearest = _distance(lattice, body)
    ease = _grown(top.cloth.ease_m, shoulder - body.rest[:, 1], 0.02, shoulder - bust + 0.18)
    trunk = _hung(
        lattice,
        (distance - ease[nearest]).reshape(lattice.shape),
        from_height=float(np.median(body.points[np.abs(body.rest[:, 1] - bust) < 0.02, 1])),
        fall=top.cloth.fall,
    )
    # A plane through the nape and the front of the neck's root.
    back, front = marks["cervicale"], shoulder - top.neckline_m
    along = (body.rest[:, 2] - back[2]) / NECK_DEPTH_M
    above = body.rest[:, 1] - (back[1] + 0.02 + along * (front - back[1] - 0.02))
    over_hem = lattice.points()[:, 1] - hem
    cut = np.maximum(above[nearest], -over_hem)
    if top.cuffs:
        trunk = np.maximum(trunk, _gathered(distance, over_hem).reshape(lattice.shape))
    if top.opening_m > 0.0:
        cut = np.maximum(cut, _opening(lattice, body, nearest, top, marks))
    sheets = [_sheet(lattice, trunk, distance, cut)]
    bare = [samples.of(("left_hand", "right_hand"))]
    for side in SIDES:
        if top.sleeve > 0.0:
            sheets.append(_sleeve(lattice, samples, side, top, marks))
            arm = samples.of((f"{side}_forearm",))
        else:
            arm = samples.of((f"{side}_upper_arm", f"{side}_forearm"))
        bare.append(arm.chosen(samples.along_arm(arm, side) > top.sleeve + 0.05))
    top_height = float(shoulder) - float(samples.rest[:, 1].min())
    return _mesh(
        lattice,
        sheets,
        bare,
        top.cloth,
        rng,
        top_height=top_height,
        clearance=top.clearance_m,
        label=label,
    )


def _gathered(
    distance: Float[np.ndarray, " k"], before_edge: Float[np.ndarray, " k"]
) -> Float[np.ndarray, " k"]:
    """A field that a ribbed cuff bounds: close at the edge, where the garment blouses over it."""
    rise = np.maximum(before_edge - CUFF_M, 0.0)
    return distance - (CUFF_EASE_M + BLOUSING * rise)


def _opening(
    lattice: _Lattice,
    samples: SkinSamples,
    nearest: np.ndarray,
    top: Top,
    marks: Mapping[str, Float[np.ndarray, "3"]],
) -> Float[np.ndarray, " k"]:
    """Positive where an open jacket shows what is under it: before the trunk, wider downward.

    ``nearest`` (k,) is the sample nearest to each place of the lattice.
    """
    rest, shoulder = samples.rest, marks["left_acromion"][1]
    down = smooth_step(shoulder - rest[:, 1], -0.05, shoulder - marks["crotch"][1])
    half = top.opening_m * (0.55 + 0.45 * down)
    before = rest[:, 2] > marks["cervicale"][2] + 0.4 * NECK_DEPTH_M
    shown = np.where(before, half - np.abs(rest[:, 0]), -half)[nearest]
    return gaussian_filter(shown.reshape(lattice.shape), 1.0).ravel()


def _sleeve(
    lattice: _Lattice,
    samples: SkinSamples,
    side: str,
    top: Top,
    marks: Mapping[str, Float[np.ndarray, "3"]],
) -> _Sheet:
    arm = samples.of((*(f"{side}_{part}" for part in ARM_PARTS), "chest"))
    along = samples.along_arm(arm, side)
    distance, nearest = _distance(lattice, arm)
    ease = _grown(0.85 * top.cloth.ease_m, along, -0.05, 0.45)
    ease[arm.is_part("chest")] = min(0.004, top.cloth.ease_m)
    # Short of the shoulder the trunk's own field goes on.
    cut = ARM_LENGTH_M * np.maximum(along[nearest] - top.sleeve, -0.15 - along[nearest])
    if top.opening_m > 0.0:
        # A sleeve's sheet goes on over the chest.
        cut = np.maximum(cut, _opening(lattice, arm, nearest, top, marks))
    field = distance - ease[nearest]
    if top.cuffs:
        field = np.maximum(field, _gathered(distance, ARM_LENGTH_M * (top.sleeve - along[nearest])))
    return _sheet(lattice, field, distance, cut)


def _bottom(
    staged: Staged, samples: SkinSamples, bottom: Bottom, over: float, rng: np.random.Generator
) -> PersonMesh:
    """Close to the body as far down as a top hangs over it."""
    marks = rest_landmarks(staged.person)
    stature, floor = _stature(samples), float(samples.rest[:, 1].min())
    waist, hem = floor + bottom.waist * stature, _floor(staged) + bottom.hem * stature
    crotch = float(marks["crotch"][1])
    cloth = bottom.cloth
    groups = [("pelvis", "spine", "chest", *LEG_PARTS)]
    if not bottom.skirt:
        groups = [
            ("pelvis", "spine", "chest", *(part for part in LEG_PARTS if part.startswith(side)))
            for side in SIDES
        ]
    everything = samples.of(groups[0] if bottom.skirt else (*groups[0], *groups[1]))
    lattice = _lattice(samples, everything.points[everything.rest[:, 1] < waist + 0.05], lowest=hem)
    sheets: list[_Sheet] = []
    for parts in groups:
        part = samples.of(parts)
        distance, nearest = _distance(lattice, part)
        start = min(floor + over * stature, crotch + 0.06) - 0.01
        close = min(0.006, 0.5 * cloth.ease_m)
        ease = close + _grown(cloth.ease_m - close, start - part.rest[:, 1], 0.0, 0.2)
        seat = float(np.median(part.points[np.abs(part.rest[:, 1] - (crotch + 0.08)) < 0.02, 1]))
        field = _hung(
            lattice,
            (distance - ease[nearest]).reshape(lattice.shape),
            from_height=min(_floor(staged) + over * stature, seat if bottom.skirt else seat - 0.12),
            fall=cloth.fall,
        )
        over_hem = lattice.points()[:, 1] - hem
        if bottom.cuffs:
            field = np.maximum(field, _gathered(distance, over_hem).reshape(lattice.shape))
        above = part.rest[nearest, 1] - waist
        cut = np.maximum(above, -over_hem)
        sheets.append(_sheet(lattice, field, distance, cut))
    bare = [samples.of(tuple(f"{side}_{part}" for part in ("forearm", "hand"))) for side in SIDES]
    below = bottom.waist * stature
    return _mesh(
        lattice,
        sheets,
        bare,
        cloth,
        rng,
        top_height=below,
        clearance=bottom.clearance_m,
        label=Label.LOWER,
    )


def _shoe(
    staged: Staged, samples: SkinSamples, shoes: Shoes, side: str, rng: np.random.Generator
) -> PersonMesh:
    """Close round the foot to the ankle, and straight down from its widest to the floor."""
    foot = samples.of((f"{side}_foot", f"{side}_shin"))
    height = foot.rest[:, 1] - float(samples.rest[:, 1].min())
    foot = foot.chosen(height < SHOE_HEIGHT_M + 0.06)
    height = foot.rest[:, 1] - float(samples.rest[:, 1].min())
    lattice = _lattice(samples, foot.points, lowest=0.0)
    distance, nearest = _distance(lattice, foot)
    field = _hung(
        lattice,
        (distance - SHOE_EASE_M).reshape(lattice.shape),
        from_height=float(foot.points[:, 1].min()) + 0.02,
        fall=0.0,
    )
    cut = np.maximum(height[nearest] - SHOE_HEIGHT_M, -lattice.points()[:, 1])
    leather = Cloth(colour=shoes.colour, fold_m=0.0)
    mesh = _mesh(
        lattice,
        [_sheet(lattice, field, distance, cut)],
        [],
        leather,
        rng,
        top_height=0.0,
        clearance=CLEARANCE_M,
        label=Label.SHOES,
    )
    mesh.albedo[mesh.vertices[:, 1] < shoes.sole_m + 0.006] = shoes.sole_colour
    return mesh


def _floor(staged: Staged) -> float:
    """Height of the feet's soles, world."""
    outfit = staged.case.outfit
    return 0.0 if outfit is None else outfit.sole_m


def _stature(samples: SkinSamples) -> float:
    return float(np.ptp(samples.rest[:, 1]))


def _sheet(
    lattice: _Lattice,
    field: Float[np.ndarray, "..."],
    skin: Float[np.ndarray, " k"],
    cut: Float[np.ndarray, " k"],
) -> _Sheet:
    return _Sheet(
        field=field.reshape(lattice.shape),
        skin=skin.reshape(lattice.shape),
        cut=cut.reshape(lattice.shape),
    )


def _lattice(samples: SkinSamples, points: Vertices, *, lowest: float) -> _Lattice:
    low, high = points.min(axis=0) - MARGIN_M, points.max(axis=0) + MARGIN_M
    low[1] = max(low[1], lowest - 0.05)
    x, y, z = np.ceil((high - low) / VOXEL_M).astype(int) + 1
    shape = (int(x), int(y), int(z))
    places = _places(low, shape)
    away, nearest = _nearest(places, samples.points)
    behind = np.einsum("ki,ki->k", places - samples.points[nearest], samples.normals[nearest])
    skin_deep = (away < REACH_M) & (behind < 0.0)
    within = np.where(skin_deep, samples.parts[nearest], -1)
    return _Lattice(origin=low, shape=shape, within=within, away=away)


def _places(origin: Float[np.ndarray, "3"], shape: tuple[int, int, int]) -> Vertices:
    index = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
    return origin + VOXEL_M * index.reshape(-1, 3)


def _distance(lattice: _Lattice, group: SkinSamples) -> tuple[Float[np.ndarray, " k"], np.ndarray]:
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


def _grown(
    most: float, along: Float[np.ndarray, " k"], start: float, end: float
) -> Float[np.ndarray, " k"]:
    """From 5 mm, or less, at ``start`` to ``most`` at ``end``."""
    least = min(0.005, most)
    return least + (most - least) * smooth_step(along, start, end)


def _hung(lattice: _Lattice, field: Field, *, from_height: float, fall: float) -> Field:
    """Below a height the cloth goes on from what is above it, falling inward by ``fall``."""
    hung = field.copy()
    heights = lattice.heights()
    for row in range(len(heights) - 2, -1, -1):
        if heights[row] < from_height:
            hung[:, row] = np.minimum(hung[:, row], hung[:, row + 1] + fall * VOXEL_M)
    return hung


def _mesh(
    lattice: _Lattice,
    sheets: list[_Sheet],
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
