"""Random garments as layers: trousers, skirts, dresses, tops, and what is worn over them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from fitter.detection.worn_parts import WornPart
from fitter.training.dressed.bodies import SIDES, StandingBody
from fitter.training.dressed.cloths import cloth, cloth_colour
from fitter.training.dressed.surfaces import (
    Cut,
    Hang,
    Layer,
    Paint,
    Places,
    blob,
    loose_places,
    moved_out,
    noise,
    smooth_step,
    tube,
)
from fitter.vocabulary.choices import Gender

UNDERWEAR_RANK, TUCKED_RANK, LOWER_RANK = 1.0, 1.8, 2.0
TOP_RANK, SKIRT_RANK, OUTER_RANK = 3.0, 3.2, 4.0
COLLAR_RISE, HOOD_RISE = 0.3, 0.1
"""Ranks above the garment's own."""

Range = tuple[float, float]


class Legs(NamedTuple):
    """How often trousers are of a kind; metres off the skin where they lie on it, and at a leg."""

    share: float
    close_m: float
    tube_m: Range | None = None


TROUSERS: Final = {
    "slim": Legs(0.13, 0.006),
    "straight": Legs(0.2, 0.012, (0.01, 0.03)),
    "wide": Legs(0.12, 0.015, (0.025, 0.075)),
    "shorts": Legs(0.42, 0.01, (0.01, 0.05)),
    "leggings": Legs(0.07, 0.003),
    "joggers": Legs(0.06, 0.015, (0.02, 0.045)),
}

NECKLINES: Final = {"crew": 0.42, "scoop": 0.2, "v": 0.18, "boat": 0.08, "high": 0.12}


class Fit(NamedTuple):
    """How often tops fit so; metres off shoulders and arms, and off the trunk."""

    share: float
    ease_m: float
    tube_m: Range


FITS: Final = {
    "tight": Fit(0.25, 0.005, (0.004, 0.012)),
    "usual": Fit(0.45, 0.011, (0.012, 0.035)),
    "wide": Fit(0.3, 0.016, (0.03, 0.07)),
}


class Outer(NamedTuple):
    """Metres that an outer garment's trunk stands off, and of its hem above the crotch."""

    tube_m: Range = (0.03, 0.1)
    hem_m: Range = (-0.08, 0.16)


OUTERS: Final = {
    "jacket": Outer(),
    "coat": Outer((0.04, 0.11), (-0.45, -0.1)),
    "vest": Outer(),
    "cardigan": Outer(hem_m=(-0.3, 0.1)),
    "shirt": Outer((0.03, 0.1)),
    "blazer": Outer((0.02, 0.07), (-0.12, 0.0)),
    "down": Outer((0.04, 0.1), (-0.05, 0.15)),
    "hoodie": Outer(),
}

SHORT_SLEEVE: Final = 0.12
"""A sleeve that ends before is none: the shoulder's edge is cut."""


def pick(rng: np.random.Generator, shares: Mapping[str, float]) -> str:
    """One of the names, by their shares."""
    return str(rng.choice(list(shares), p=list(shares.values())))


def underwear(body: StandingBody, rng: np.random.Generator) -> Layer:
    """Briefs, and a woman's bra: swimwear, where nothing lies over them."""
    rest, marks = body.rest, body.rest.marks
    crotch = marks["crotch"][1]
    bust = _bust(body)
    waist = crotch + rng.uniform(0.09, 0.2)
    woman = rest.gender is Gender.FEMALE

    def keeps(at: Places) -> Bool[np.ndarray, " k"]:
        leg = crotch + (0.02 + 0.5 * np.abs(at.x) if woman else -0.08)
        kept = (at.y < waist) & (at.y > leg) & ~at.on_arm
        band = (np.abs(at.y - bust + 0.005) < 0.065) & (at.arm < 0.3)
        return kept | band if woman else kept

    y = rest.points[:, 1]
    trunk = ~rest.on_arms & (y < marks["left_acromion"][1]) & (y > crotch - 0.15)
    return Layer(
        vertices=moved_out(body, np.full(len(y), 0.003), rounds=0),
        triangles=rest.triangles_of(trunk),
        places=rest.places(),
        part=WornPart.CLOTH,
        paint=cloth(rng),
        keeps=keeps,
        rank=UNDERWEAR_RANK,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LegsCut:
    """Trousers.

    Attributes
    ----------
    waist, hem
        Heights at rest.
    close_m
        How far they stand off where they lie on the skin.
    tube_m
        How far a leg stands off; None where it lies on the skin.
    cuffed
        Whether they are gathered at the hem.
    """

    paint: Paint
    waist: float
    hem: float
    close_m: float
    tube_m: float | None
    cuffed: bool
    fall: float
    folds: float


def trousers(body: StandingBody, rng: np.random.Generator) -> list[Layer]:
    """Long or short, close or wide."""
    marks = body.rest.marks
    crotch, ankle, knee = marks["crotch"][1], marks["left_ankle"][1], marks["left_knee"][1]
    name = pick(rng, {name: each.share for name, each in TROUSERS.items()})
    kind = TROUSERS[name]
    waist = waist_height(body, rng)
    hem = ankle + rng.uniform(-0.05, 0.08) + 0.12 * (rng.random() < 0.15)
    if name == "shorts":
        hem = rng.uniform(knee - 0.06, crotch - 0.03)
    cut = LegsCut(
        paint=cloth(rng, plain=0.75),
        waist=waist,
        hem=hem,
        close_m=kind.close_m * rng.uniform(0.7, 1.6),
        tube_m=None if kind.tube_m is None else rng.uniform(*kind.tube_m),
        cuffed=name == "joggers",
        fall=rng.uniform(0.0, 0.12),
        folds=rng.uniform(0.1, 0.8),
    )
    return legs(body, cut, rng)


def legs(body: StandingBody, cut: LegsCut, rng: np.random.Generator) -> list[Layer]:
    """Skin moved out, and a tube around each wide leg."""
    rest, wave = body.rest, _uneven_hem(rng, 0.006)
    y, knee = rest.points[:, 1], rest.marks["left_knee"][1]
    ease = np.maximum(cut.close_m * (1.0 + 0.5 * noise(rng, rest.points, 0.15)), 0.003)
    covered = ~rest.on_arms & (y < cut.waist + 0.06) & (y > cut.hem - 0.06)
    layers = [
        Layer(
            vertices=moved_out(body, ease, rounds=2),
            triangles=rest.triangles_of(covered),
            places=rest.places(),
            part=WornPart.CLOTH,
            paint=cut.paint,
            keeps=lambda at: (at.y < cut.waist) & (at.y > cut.hem + wave(at)) & ~at.on_arm,
            rank=LOWER_RANK,
            folds=cut.folds,
            fold_size=rng.uniform(0.5, 1.5),
        )
    ]
    wide, cuffed = cut.tube_m, cut.cuffed
    if wide is None:
        return layers
    for side, sign in SIDES:
        leg = rest.on("thigh", "shin") & (sign * rest.points[:, 0] > 0.0)
        hang = Hang(
            top_m=float(body.marks[f"{side}_hip"][1]) - 0.08 * body.scale,
            hem_m=float(body.marks[f"{side}_knee"][1]) + (cut.hem - knee) * body.scale,
            ease=lambda share: (
                wide * np.clip(0.25 + 1.1 * share, 0, 1) * np.where(cuffed & (share > 0.9), 0.2, 1)
            ),
            fall=0.6 if cuffed else cut.fall,
            uneven=rng.uniform(0.0, 0.3),
            rows=36,
            bins=36,
        )
        layers += hung(body, body.vertices[leg], hang, cut.paint, rng, LOWER_RANK, cut.folds)
    return layers


def skirt(
    body: StandingBody, rng: np.random.Generator, paint: Paint, *, from_height: float
) -> list[Layer]:
    """A tube around both legs from some height at rest: a skirt, or the lower part of a dress."""
    rest, marks = body.rest, body.rest.marks
    hem = rng.uniform(marks["left_ankle"][1] + 0.03, marks["crotch"][1] - 0.12)
    top_m, hem_m = rng.uniform(0.004, 0.02), rng.uniform(0.005, 0.06)
    hang = Hang(
        top_m=from_height * body.scale,
        hem_m=hem * body.scale,
        ease=lambda share: top_m + (hem_m - top_m) * share,
        fall=rng.uniform(-0.02, 0.15),
        flare=rng.uniform(0.0, 0.18) if rng.random() < 0.6 else 0.0,
        waves_m=rng.uniform(0.0, 0.02),
        uneven=rng.uniform(0.0, 0.3),
        rows=60,
    )
    about = ~rest.on_arms & ~rest.on("foot") & (rest.points[:, 1] < from_height + 0.1)
    folds = rng.uniform(0.2, 0.9)
    return hung(body, body.vertices[about], hang, paint, rng, SKIRT_RANK, folds)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class UpperCut:
    """A top or an outer garment.

    Attributes
    ----------
    ease_m
        How far it stands off shoulders and arms.
    hang
        Its trunk below the bust; None where it lies on the skin.
    hem
        Height at rest.
    sleeve
        Share of the arm.
    opening
        Where the front shows what is under it; None where it is closed.
    drop_m
        How far it hangs under the arms.
    """

    part: WornPart
    paint: Paint
    rank: float
    ease_m: float
    hang: Callable[[np.ndarray], np.ndarray] | None
    hem: float
    sleeve: float
    neck: Cut
    fall: float
    drop_m: float
    folds: float
    opening: Cut | None = None


def upper(body: StandingBody, cut: UpperCut, rng: np.random.Generator) -> list[Layer]:
    """Skin moved out over shoulders, arms and trunk, and a tube that hangs from the bust."""
    rest = body.rest
    y = rest.points[:, 1]
    shoulder, aside = rest.marks["left_acromion"][1], abs(rest.marks["left_acromion"][0])
    ease = cut.ease_m * (1.0 + 0.4 * noise(rng, rest.points, 0.15))
    lower = 0.55 + 0.45 * smooth_step(shoulder - y, 0.0, 0.12)
    ease = np.maximum(np.where(rest.on_arms, ease, ease * lower), 0.004 + 0.0015 * cut.rank)
    ease = np.where(y > shoulder, 0.6 * ease, ease)
    wave = _uneven_hem(rng, 0.008)
    edge = aside * (1.0 if cut.sleeve > 0.0 else 0.86)

    def keeps(at: Places) -> Bool[np.ndarray, " k"]:
        kept = cut.neck(at) & np.where(
            at.on_arm, at.along_arm < cut.sleeve, at.y > cut.hem + wave(at)
        )
        if cut.sleeve < SHORT_SLEEVE:
            kept &= at.on_arm | (np.abs(at.x) <= edge) | (at.y <= shoulder - 0.16)
        return kept if cut.opening is None else kept & ~cut.opening(at)

    reached = (y > cut.hem - 0.06) & (~rest.on_arms | (rest.along_arm < cut.sleeve + 0.15))
    layers = [
        Layer(
            vertices=moved_out(body, ease, drop_m=cut.drop_m),
            triangles=rest.triangles_of(
                reached & ~rest.on("head") & (~rest.on("neck") | (y < rest.marks["chin"][1] - 0.01))
            ),
            places=rest.places(),
            part=cut.part,
            paint=cut.paint,
            keeps=keeps,
            rank=cut.rank,
            folds=cut.folds,
            fold_size=rng.uniform(0.6, 1.6),
        )
    ]
    if cut.hang is None:
        return layers
    hang = Hang(
        top_m=(_bust(body) + rng.uniform(0.0, 0.05)) * body.scale,
        hem_m=cut.hem * body.scale,
        ease=cut.hang,
        fall=cut.fall,
        waves_m=rng.uniform(0.0, 0.008),
        uneven=rng.uniform(0.0, 0.25),
    )
    about = body.vertices[~rest.on_arms & ~rest.on_head]
    opening = cut.opening
    closed = None if opening is None else lambda at: ~opening(at)
    return layers + hung(
        body, about, hang, cut.paint, rng, cut.rank, cut.folds, part=cut.part, keeps=closed
    )


def top(
    body: StandingBody, rng: np.random.Generator, paint: Paint, *, dress: bool, tucked: bool
) -> list[Layer]:
    """A shirt, blouse, sweater or the upper part of a dress."""
    marks = body.rest.marks
    crotch = marks["crotch"][1]
    neck = neckline(body, pick(rng, NECKLINES), rng.uniform(0.03, 0.13), rng.uniform(0.06, 0.11))
    sleeves = rng.uniform([-0.05, 0.18, 0.5, 0.9], [0.06, 0.5, 0.85, 1.03])
    hem = crotch + rng.uniform(-0.1, 0.1)
    if body.rest.gender is Gender.FEMALE and rng.random() < 0.25:
        hem = marks["navel"][1] + rng.uniform(-0.02, 0.14)
    kind = pick(rng, {name: each.share for name, each in FITS.items()})
    fit, tight = FITS[kind], kind == "tight"
    off_m = rng.uniform(*fit.tube_m)
    falls = (rng.uniform(0.0, 0.1), rng.uniform(0.1, 0.4))
    cut = UpperCut(
        part=WornPart.CLOTH,
        paint=paint,
        rank=TUCKED_RANK if tucked else TOP_RANK,
        ease_m=fit.ease_m * rng.uniform(0.8, 1.4),
        hang=None if dress or tucked else lambda share: off_m * (0.6 + 0.4 * np.sin(np.pi * share)),
        hem=_bust(body) - 0.08 if dress else hem,
        sleeve=float(rng.choice(sleeves, p=[0.2, 0.42, 0.08, 0.3])),
        neck=neck,
        fall=0.8 if tight else float(rng.choice(falls)),
        drop_m=0.0 if tight else rng.uniform(0.0, 0.04),
        folds=rng.uniform(0.0, 0.3) if tight else rng.uniform(0.1, 0.7),
    )
    return upper(body, cut, rng)


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
    off_m = rng.uniform(*OUTERS[kind].tube_m)
    half_m = rng.uniform(0.02, 0.13)
    opening = front_gap(body, rng, half_m)
    fabric = cloth(rng, plain=0.62)
    cut = UpperCut(
        part=WornPart.OUTER,
        paint=_sewn(fabric, rng, opening=opening, closed=closed, quilted=kind == "down"),
        rank=OUTER_RANK,
        ease_m=rng.uniform(0.012, 0.03),
        hang=lambda share: off_m * (0.7 + 0.3 * share),
        hem=crotch + rng.uniform(*OUTERS[kind].hem_m),
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


def waist_height(body: StandingBody, rng: np.random.Generator) -> float:
    """A waistband's height at rest."""
    return float(body.rest.marks["navel"][1]) + rng.uniform(-0.07, 0.06)


def neckline(body: StandingBody, kind: str, depth_m: float, half_m: float) -> Cut:
    """Below a plane from the nape to the neck's pit, and in front below a shape."""
    marks = body.rest.marks
    nape, pit = marks["cervicale"], marks["left_acromion"][1] + 0.015
    ahead = marks["neck"][2] + 0.05 - nape[2]

    def keeps(at: Places) -> Bool[np.ndarray, " k"]:
        front = np.clip((at.z - nape[2]) / ahead, 0.0, 1.0)
        plane = nape[1] + 0.015 + front * (pit - nape[1] - 0.015)
        across = np.abs(at.x) / half_m
        round_ = np.sqrt(np.maximum(1.0 - across**2, 0.0))
        match kind:
            case "crew":
                lower = min(depth_m, 0.035) * round_
            case "scoop":
                lower = depth_m * round_
            case "v":
                lower = 1.5 * depth_m * np.maximum(1.0 - across, 0.0)
            case "boat":
                lower = 0.6 * depth_m * np.maximum(1.0 - (0.6 * across) ** 4, 0.0)
            case _:
                lower = np.full_like(across, -0.05)
        return at.y < plane - lower * smooth_step(front, 0.2, 0.7)

    return keeps


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


def hung(
    body: StandingBody,
    points: np.ndarray,
    hang: Hang,
    paint: Paint,
    rng: np.random.Generator,
    rank: float,
    folds: float,
    *,
    part: WornPart = WornPart.CLOTH,
    keeps: Cut | None = None,
) -> list[Layer]:
    """A tube about points of the body; no layer where there is next to none."""
    sheet = tube(points, hang, rng)
    if sheet is None:
        return []
    return [
        Layer(
            vertices=sheet.vertices,
            triangles=sheet.triangles,
            places=loose_places(sheet.vertices, body.scale),
            part=part,
            paint=paint,
            keeps=keeps,
            rank=rank,
            folds=folds,
        )
    ]


def _uneven_hem(rng: np.random.Generator, most_m: float) -> Callable[[Places], np.ndarray]:
    high, often, phase = rng.uniform(0.0, most_m), rng.uniform(8.0, 30.0), rng.uniform(0.0, 6.28)
    return lambda at: high * np.sin(often * at.x + 5.0 * at.z + phase)


def _bust(body: StandingBody) -> float:
    marks = body.rest.marks
    return float(0.5 * (marks["left_nipple"] + marks["right_nipple"])[1])
