"""Random garments as layers: trousers, skirts, dresses and tops."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Bool

from fitter.detection.worn_parts import WornPart
from fitter.training.dressed.bodies import SIDES, StandingBody
from fitter.training.dressed.cloths import cloth
from fitter.training.dressed.surfaces import (
    Cut,
    Hang,
    Layer,
    Paint,
    Places,
    loose_places,
    moved_out,
    noise,
    smooth_step,
    tube,
)
from fitter.vocabulary.choices import Gender

UNDERWEAR_RANK, TUCKED_RANK, LOWER_RANK = 1.0, 1.8, 2.0
TOP_RANK, SKIRT_RANK = 3.0, 3.2

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

SHORT_SLEEVE: Final = 0.12
"""A sleeve that ends before is none: the shoulder's edge is cut."""


def pick(rng: np.random.Generator, shares: Mapping[str, float]) -> str:
    """One of the names, by their shares."""
    return str(rng.choice(list(shares), p=list(shares.values())))


def underwear(body: StandingBody, rng: np.random.Generator) -> Layer:
    """Briefs, and a woman's bra: swimwear, where nothing lies over them."""
    rest, marks = body.rest, body.rest.marks
    crotch = marks["crotch"][1]
    waist = crotch + rng.uniform(0.09, 0.2)
    woman = rest.gender is Gender.FEMALE

    def keeps(at: Places) -> Bool[np.ndarray, " k"]:
        leg = crotch + (0.02 + 0.5 * np.abs(at.x) if woman else -0.08)
        kept = (at.y < waist) & (at.y > leg) & ~at.on_arm
        band = (np.abs(at.y - _bust(body) + 0.005) < 0.065) & (at.arm < 0.3)
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
