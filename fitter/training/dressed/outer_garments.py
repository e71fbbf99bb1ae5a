"""Random garments worn over a top, as layers: jackets, coats, vests, cardigans, open shirts."""

from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from fitter.detection.worn_parts import WornPart
from fitter.training.dressed.bodies import StandingBody
from fitter.training.dressed.cloths import cloth, cloth_colour
from fitter.training.dressed.garments import UpperCut, neckline, upper
from fitter.training.dressed.surfaces import (
    Cut,
    Layer,
    Paint,
    Places,
    blob,
    loose_places,
    moved_out,
)

OUTER_RANK = 4.0
COLLAR_RISE, HOOD_RISE = 0.3, 0.1
"""Ranks above the garment's own."""


OUTERS: Final = {
    "jacket": ((0.03, 0.1), (-0.08, 0.16)),
    "coat": ((0.04, 0.11), (-0.45, -0.1)),
    "vest": ((0.03, 0.1), (-0.08, 0.16)),
    "cardigan": ((0.03, 0.1), (-0.3, 0.1)),
    "shirt": ((0.03, 0.1), (-0.08, 0.16)),
    "blazer": ((0.02, 0.07), (-0.12, 0.0)),
    "down": ((0.04, 0.1), (-0.05, 0.15)),
    "hoodie": ((0.03, 0.1), (-0.08, 0.16)),
}
"""Ranges of how far the trunk of each stands off, and of its hem above the crotch, metres."""


def outer(body: StandingBody, rng: np.random.Generator) -> list[Layer]:
    """A jacket, coat, vest, cardigan, open shirt, blazer, down jacket or hooded jacket."""
    crotch = body.rest.marks["crotch"][1]
    kind = str(rng.choice(list(OUTERS)))
    closed = kind != "shirt" and rng.random() < 0.25
    sleeve = rng.uniform(0.88, 1.06)
    if kind == "vest" or (kind == "down" and rng.random() < 0.5):
        sleeve = -0.02
    elif kind in ("shirt", "cardigan") and rng.random() < 0.3:
        sleeve = rng.uniform(0.3, 0.8)
    tube_m, hem_m = OUTERS[kind]
    off_m = rng.uniform(*tube_m)
    half_m = rng.uniform(0.02, 0.13)
    opening = front_gap(body, rng, half_m)
    fabric = cloth(rng, plain=0.62)
    cut = UpperCut(
        part=WornPart.OUTER,
        paint=_sewn(fabric, rng, opening=opening, closed=closed, quilted=kind == "down"),
        rank=OUTER_RANK,
        ease_m=rng.uniform(0.012, 0.03),
        hang=lambda share: off_m * (0.7 + 0.3 * share),
        hem=crotch + rng.uniform(*hem_m),
        sleeve=sleeve,
        neck=neckline(
            body, str(rng.choice(["crew", "high", "v", "high"])), rng.uniform(0.02, 0.12), 0.09
        ),
        fall=rng.uniform(-0.02, 0.12),
        drop_m=rng.uniform(0.0, 0.16),
        folds=rng.uniform(0.2, 1.0),
        opening=None if closed else opening,
    )
    layers = upper(body, cut, rng)
    if rng.random() < 0.75:
        layers.append(_collar(body, rng, fabric, half_m))
    if kind == "hoodie" or rng.random() < 0.12:
        layers.append(_hood(body, rng, fabric))
    return layers


def _hood(body: StandingBody, rng: np.random.Generator, paint: Paint) -> Layer:
    """A hood that hangs on the nape."""
    centre = body.marks["cervicale"] + np.array([0.0, rng.uniform(-0.03, 0.02), -0.03])
    radii = np.array([rng.uniform(0.1, 0.16), rng.uniform(0.05, 0.09), 0.08])
    sheet = blob(centre, radii, rng, uneven=0.12)
    return Layer(
        vertices=sheet.vertices,
        triangles=sheet.triangles,
        places=loose_places(sheet.vertices),
        part=WornPart.OUTER,
        paint=paint,
        rank=OUTER_RANK + HOOD_RISE,
        folds=0.6,
    )


def front_gap(body: StandingBody, rng: np.random.Generator, half_m: float) -> Cut:
    """What two fronts leave open, ever wider or narrower downward."""
    marks = body.rest.marks
    shoulder, crotch = marks["left_acromion"][1], marks["crotch"][1]
    front = marks["cervicale"][2] + 0.025
    wider, aside, bent = rng.uniform(-0.02, 0.12), rng.normal(0.0, 0.015), rng.uniform(-0.03, 0.03)

    def is_open(at: Places) -> Bool[np.ndarray, " k"]:
        down = np.clip((shoulder - at.y) / (shoulder - crotch), -0.2, 1.5)
        half = half_m + wider * down + bent * np.sin(3.0 * down)
        return (np.abs(at.x - aside) < half) & (at.z > front) & ~at.on_arm

    return is_open


def _sewn(
    fabric: Paint,
    rng: np.random.Generator,
    *,
    opening: Cut,
    closed: bool,
    quilted: bool,
) -> Paint:
    """An outer garment's cloth with quilting, a zip, and edges."""
    quilt_m, zipped = rng.uniform(0.05, 0.11), closed and rng.random() < 0.7
    zip_colour, edge = cloth_colour(rng), cloth_colour(rng) if rng.random() < 0.3 else None

    def paint(at: Places) -> Float[np.ndarray, "k 3"]:
        colours = fabric(at)
        if quilted:
            down = np.where(at.on_arm, 0.55 * at.along_arm, at.y)
            colours *= (0.55 + 0.45 * np.sqrt(np.abs(np.sin(np.pi * down / quilt_m))))[:, None]
        if zipped:
            colours[(at.z > 0.0) & ~at.on_arm & (np.abs(at.x) < 0.008)] = zip_colour
        if not closed:
            beside = [opening(at._replace(x=at.x + shift)) for shift in (-0.012, 0.012)]
            seam = beside[0] | beside[1]
            colours[seam] = 0.6 * colours[seam] if edge is None else edge
        return colours

    return paint


def _collar(body: StandingBody, rng: np.random.Generator, paint: Paint, half_m: float) -> Layer:
    rest = body.rest
    nape = rest.marks["cervicale"]
    above, below = rng.uniform(0.02, 0.075), rng.uniform(0.0, 0.09)

    def keeps(at: Places) -> Bool[np.ndarray, " k"]:
        ahead = np.clip(at.z - nape[2], 0.0, 0.2)
        high, low = nape[1] + above - 0.8 * ahead, nape[1] - below - 0.6 * ahead
        gap = (np.abs(at.x) < 0.6 * half_m + 0.01) & (at.z > nape[2] + 0.045)
        return (at.y < high) & (at.y > low) & ~gap & (np.abs(at.x) < 0.13)

    return Layer(
        vertices=moved_out(body, np.full(len(rest.points), rng.uniform(0.02, 0.04)), rounds=4),
        triangles=rest.triangles_of(rest.on("neck", "chest")),
        places=rest.places(),
        part=WornPart.OUTER,
        paint=paint,
        keeps=keeps,
        rank=OUTER_RANK + COLLAR_RISE,
        folds=0.2,
    )
