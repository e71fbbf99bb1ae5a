"""Loose clothes over a posed body: surfaces of level of a field of distances.

A garment lies at a distance from the skin it covers, its ease; where the body tapers below, it
hangs on from what is above it; it bridges hollows, has folds, and ends at hem, cuff and neckline.
It is the level zero of a field on a lattice: distance less ease, smoothed, pulled down, roughened.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter

from tests.accuracy.garment_fields import (
    ARM_PARTS,
    LEG_PARTS,
    Lattice,
    Sheet,
    SkinSamples,
    cloth_mesh,
    hung,
    lattice_round,
    sheet_of,
    skin_distance,
    skin_samples,
)
from tests.accuracy.landmark_points import rest_landmarks
from tests.accuracy.meshes import PersonMesh
from tests.accuracy.noise import smooth_step
from tests.accuracy.scene import Bottom, Cloth, Label, Shoes, Top
from tests.accuracy.staging import Staged

CLEARANCE_M = 0.006
"""Shoes are no nearer to the skin."""

CUFF_M, CUFF_EASE_M, BLOUSING = 0.04, 0.006, 0.8
"""A ribbed cuff's breadth, how far it stands off, and how steeply cloth widens above it."""

SHOE_HEIGHT_M, SHOE_EASE_M = 0.075, 0.008
"""A low shoe's edge above the foot's sole."""

ARM_LENGTH_M = 0.55
"""About: turns shares of an arm into metres."""

NECK_DEPTH_M = 0.14
"""About: from the nape to the front of the neck's root."""

SIDES = ("left", "right")


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
    lattice = lattice_round(samples, np.concatenate([body.points, sleeves.points]), lowest=hem)
    bust = 0.5 * (marks["left_nipple"] + marks["right_nipple"])[1]
    shoulder = marks["left_acromion"][1]
    distance, nearest = skin_distance(lattice, body)
    ease = _grown(top.cloth.ease_m, shoulder - body.rest[:, 1], 0.02, shoulder - bust + 0.18)
    trunk = hung(
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
    sheets = [sheet_of(lattice, trunk, distance, cut)]
    bare = [samples.of(("left_hand", "right_hand"))]
    for side in SIDES:
        if top.sleeve > 0.0:
            sheets.append(_sleeve(lattice, samples, side, top, marks))
            arm = samples.of((f"{side}_forearm",))
        else:
            arm = samples.of((f"{side}_upper_arm", f"{side}_forearm"))
        bare.append(arm.chosen(samples.along_arm(arm, side) > top.sleeve + 0.05))
    top_height = float(shoulder) - float(samples.rest[:, 1].min())
    return cloth_mesh(
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
    lattice: Lattice,
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
    lattice: Lattice,
    samples: SkinSamples,
    side: str,
    top: Top,
    marks: Mapping[str, Float[np.ndarray, "3"]],
) -> Sheet:
    arm = samples.of((*(f"{side}_{part}" for part in ARM_PARTS), "chest"))
    along = samples.along_arm(arm, side)
    distance, nearest = skin_distance(lattice, arm)
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
    return sheet_of(lattice, field, distance, cut)


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
    lattice = lattice_round(
        samples, everything.points[everything.rest[:, 1] < waist + 0.05], lowest=hem
    )
    sheets: list[Sheet] = []
    for parts in groups:
        part = samples.of(parts)
        distance, nearest = skin_distance(lattice, part)
        start = min(floor + over * stature, crotch + 0.06) - 0.01
        close = min(0.006, 0.5 * cloth.ease_m)
        ease = close + _grown(cloth.ease_m - close, start - part.rest[:, 1], 0.0, 0.2)
        seat = float(np.median(part.points[np.abs(part.rest[:, 1] - (crotch + 0.08)) < 0.02, 1]))
        field = hung(
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
        sheets.append(sheet_of(lattice, field, distance, cut))
    bare = [samples.of(tuple(f"{side}_{part}" for part in ("forearm", "hand"))) for side in SIDES]
    below = bottom.waist * stature
    return cloth_mesh(
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
    lattice = lattice_round(samples, foot.points, lowest=0.0)
    distance, nearest = skin_distance(lattice, foot)
    field = hung(
        lattice,
        (distance - SHOE_EASE_M).reshape(lattice.shape),
        from_height=float(foot.points[:, 1].min()) + 0.02,
        fall=0.0,
    )
    cut = np.maximum(height[nearest] - SHOE_HEIGHT_M, -lattice.points()[:, 1])
    leather = Cloth(colour=shoes.colour, fold_m=0.0)
    mesh = cloth_mesh(
        lattice,
        [sheet_of(lattice, field, distance, cut)],
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


def _grown(
    most: float, along: Float[np.ndarray, " k"], start: float, end: float
) -> Float[np.ndarray, " k"]:
    """From 5 mm, or less, at ``start`` to ``most`` at ``end``."""
    least = min(0.005, most)
    return least + (most - least) * smooth_step(along, start, end)
