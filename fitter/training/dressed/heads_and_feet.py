"""The skin itself, with its face, and what ends a person: hair of many cuts, socks and shoes."""

from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import gaussian_filter

from fitter.arrays import Vector3, Vertices
from fitter.detection.worn_parts import WornPart
from fitter.training.dressed.bodies import SIDES, StandingBody
from fitter.training.dressed.cloths import Rgb, cloth, cloth_colour
from fitter.training.dressed.garments import pick
from fitter.training.dressed.surfaces import (
    Layer,
    Paint,
    Places,
    Sheet,
    blob,
    grid_triangles,
    loose_places,
    moved_out,
    noise,
    smooth_step,
)
from fitter.vocabulary.choices import Gender

SOCK_RANK, SHOE_RANK, LONG_HAIR_RANK, TIED_RANK, HAIR_RANK = 1.2, 1.5, 2.5, 4.5, 5.0

EYE_M, PUPIL_M, BROW_M = (0.016, 0.008, 0.03), (0.007, 0.007, 0.03), (0.022, 0.0045, 0.03)
"""Half axes of what is painted on a face; the mouth is as broad as it is."""

BROW_RISE_M: Final = 0.022


class HairCut(NamedTuple):
    """How often women and men wear it, how thick it is, and how long where it hangs, metres."""

    women: float
    men: float
    thick_m: tuple[float, float] = (0.005, 0.014)
    length_m: tuple[float, float] | None = None


HAIR: Final = {
    "short": HairCut(0.18, 0.58, (0.008, 0.03)),
    "cropped": HairCut(0.07, 0.22, (0.002, 0.008)),
    "long": HairCut(0.27, 0.04, (0.01, 0.03), (0.2, 0.5)),
    "tied": HairCut(0.2, 0.02),
    "bun": HairCut(0.1, 0.02),
    "none": HairCut(0.02, 0.06),
    "afro": HairCut(0.06, 0.04, (0.04, 0.1)),
    "bob": HairCut(0.1, 0.02, (0.015, 0.03), (0.1, 0.18)),
}


class Shoe(NamedTuple):
    """How often it is worn; its upper edge above the ankle, its sole and its ease, metres."""

    share: float
    edge_m: tuple[float, float]
    sole_m: tuple[float, float]
    ease_m: float


SHOES: Final = {
    "trainers": Shoe(0.58, (0.015, 0.05), (0.02, 0.045), 0.013),
    "low": Shoe(0.24, (-0.03, 0.01), (0.005, 0.02), 0.006),
    "boots": Shoe(0.12, (0.06, 0.35), (0.01, 0.04), 0.012),
    "socks": Shoe(0.06, (0.0, 0.1), (0.0, 0.0), 0.004),
}
BAREFOOT: Final = 0.1


def skin(body: StandingBody, colour: Rgb, hair: Rgb, rng: np.random.Generator) -> Layer:
    """The whole body, with eyes, brows, lips and sometimes a beard painted on."""
    marks = body.rest.marks
    mouth = 0.5 * (marks["left_mouth_corner"] + marks["right_mouth_corner"])
    lips = np.array([0.95 * abs(marks["left_mouth_corner"][0]), 0.009, 0.03])
    bearded = body.rest.gender is Gender.MALE and rng.random() < 0.3
    beard, seed = rng.uniform(0.2, 0.8), int(rng.integers(1 << 30))

    def paint(at: Places) -> Float[np.ndarray, "k 3"]:
        own, points = np.random.default_rng(seed), at.points
        mottled = 0.08 * noise(own, points, 0.08) + 0.05 * noise(own, points, 0.015)
        colours = colour * np.exp(mottled)[:, None]
        for side, _ in SIDES:
            eye = marks[f"{side}_eye"]
            colours[_within(points, eye, EYE_M)] = 0.5 * colour + 0.02
            colours[_within(points, eye, PUPIL_M)] = 0.02
            brow = eye + np.array([0.0, BROW_RISE_M, 0.0])
            colours[_within(points, brow, BROW_M)] = 0.35 * colour + 0.65 * hair
        on_mouth = _within(points, mouth, lips)
        colours[on_mouth] = colour * np.array([0.85, 0.55, 0.55])
        if bearded:
            below = smooth_step(marks["nose"][1] - 0.01 - at.y, 0.0, 0.012)
            before = smooth_step(at.z - marks["left_ear"][2], 0.0, 0.03)
            share = beard * below * before * (at.y > marks["neck"][1] + 0.04) * ~on_mouth
            colours += share[:, None] * (hair - colours)
        return colours

    return Layer(
        vertices=body.vertices,
        triangles=body.rest.model.triangles,
        places=body.rest.places(),
        part=WornPart.SKIN,
        paint=paint,
        rank=0.0,
        gloss=rng.uniform(0.0, 0.25),
    )


def footwear(body: StandingBody, rng: np.random.Generator) -> list[Layer]:
    """Socks, shoes, both, or nothing."""
    if rng.random() < BAREFOOT:
        return []
    rest = body.rest
    y, ankle = rest.points[:, 1], rest.marks["left_ankle"][1]
    kind = pick(rng, {name: each.share for name, each in SHOES.items()})
    shoe = SHOES[kind]
    lower_legs = rest.triangles_of(rest.on_legs & (y < ankle + 0.45))
    layers: list[Layer] = []
    if kind != "socks" and rng.random() < 0.5:
        edges = rng.uniform([0.03, 0.1], [0.09, 0.25])
        sock_edge = ankle + float(rng.choice(edges, p=[0.6, 0.4]))
        greys = (np.full(3, rng.uniform(0.5, 0.8)), np.full(3, 0.02))
        colour = cloth_colour(rng) if rng.random() < 0.3 else greys[rng.integers(2)]
        layers.append(
            Layer(
                vertices=moved_out(body, np.full(len(y), 0.004), rounds=1),
                triangles=lower_legs,
                places=rest.places(),
                part=WornPart.SHOES,
                paint=cloth(rng, plain=0.8, colour=colour),
                keeps=lambda at: at.y < sock_edge,
                rank=SOCK_RANK,
            )
        )
    edge, sole = ankle + rng.uniform(*shoe.edge_m), rng.uniform(*shoe.sole_m)
    layers.append(
        Layer(
            vertices=shod(body, shoe.ease_m, sole, rng, broad=kind != "socks"),
            triangles=lower_legs,
            places=rest.places(),
            part=WornPart.SHOES,
            paint=_leather(rest.floor + 0.022, rng, two=kind == "trainers"),
            keeps=lambda at: at.y < edge,
            rank=SHOE_RANK,
            gloss=rng.uniform(0.0, 0.3),
        )
    )
    return layers


def hair(body: StandingBody, colour: Rgb, rng: np.random.Generator) -> list[Layer]:
    """A cap on the scalp above a hairline, and long, tied or pinned hair."""
    rest = body.rest
    woman = rest.gender is Gender.FEMALE
    kind = pick(rng, {name: each.women if woman else each.men for name, each in HAIR.items()})
    if kind == "none":
        return []
    thick, length_m = rng.uniform(*HAIR[kind].thick_m), HAIR[kind].length_m
    eye = rest.marks["left_eye"][1]
    grown = 0.35 + 0.65 * smooth_step(rest.points[:, 1], eye - 0.03, eye + 0.09)
    ease = thick * (1.0 + 0.35 * noise(rng, rest.points, 0.05)) * grown
    paint, gloss = _strands(colour, rng), rng.uniform(0.0, 0.4)
    layers = [
        Layer(
            vertices=moved_out(body, np.maximum(ease, 0.003), rounds=4 if kind == "afro" else 1),
            triangles=rest.triangles_of(rest.on_head),
            places=rest.places(),
            part=WornPart.HAIR,
            paint=paint,
            keeps=_above_hairline(body, rng),
            rank=HAIR_RANK,
            gloss=gloss,
        )
    ]
    head = _Head(body)
    if length_m is not None:
        sheet = head.curtain(rng.uniform(*length_m), thick, rng)
        layers.append(_loose(sheet, paint, LONG_HAIR_RANK, gloss))
    elif kind == "tied":
        root = head.middle - (0.09 + thick) * head.forward + rng.uniform(-0.03, 0.08) * head.up
        length = rng.uniform(0.08, 0.2)
        for number in range(3):
            down = np.array([0.0, 0.8 * number * length, 0.0])
            centre = root - down - 0.02 * head.forward + rng.normal(0.0, 0.008, 3)
            radii = np.array([rng.uniform(0.02, 0.04), 0.7 * length, 0.03])
            layers.append(_loose(blob(centre, radii, rng, uneven=0.2), paint, TIED_RANK, gloss))
    elif kind == "bun":
        centre = head.middle - rng.uniform(0.02, 0.11) * head.forward
        centre = centre + rng.uniform(0.05, 0.16) * head.up
        radii = np.full(3, rng.uniform(0.03, 0.055))
        layers.append(_loose(blob(centre, radii, rng, uneven=0.15), paint, TIED_RANK, gloss))
    return layers


class _Head:
    """A posed head: the point between the ears and its axes."""

    def __init__(self, body: StandingBody) -> None:
        left, right = body.marks["left_ear"], body.marks["right_ear"]
        self.middle = 0.5 * (left + right)
        self.half_breadth = 0.5 * float(np.linalg.norm(left - right))
        self.up = _unit(body.marks["crown"] - body.marks["neck"])
        self.forward = _unit(np.cross(left - right, self.up))

    def curtain(self, length_m: float, thick_m: float, rng: np.random.Generator) -> Sheet:
        """Hair that hangs around the back of the head, seen from both sides."""
        rows, columns = 30, 40
        angle = np.pi + np.linspace(-1.0, 1.0, columns) * np.radians(rng.uniform(95.0, 150.0))
        down = np.linspace(0.0, 1.0, rows)[:, None]
        radius = self.half_breadth + thick_m + rng.uniform(0.0, 0.02)
        uneven = 0.24 * gaussian_filter(rng.normal(size=(rows, columns)), (6, 2))
        out = radius * (1.0 + rng.uniform(-0.25, 0.35) * down) * (1.0 + uneven)
        aside = np.cross(self.up, self.forward)
        back = 1.05 * np.cos(angle) * out - 0.05 * np.clip(down - 0.35, 0, 1) * np.abs(
            np.cos(angle)
        )
        vertices = (
            self.middle
            + 0.03 * self.up
            + (np.sin(angle) * out)[..., None] * aside
            + back[..., None] * self.forward
            - (length_m * down)[..., None] * np.array([0.0, 1.0, 0.0])
        ).reshape(-1, 3)
        triangles = grid_triangles(rows, columns, closed=False)
        return Sheet(vertices, np.concatenate([triangles, triangles[:, ::-1]]))


def _above_hairline(body: StandingBody, rng: np.random.Generator):
    marks = body.rest.marks
    eye, ear = marks["left_eye"][1], marks["left_ear"][2]
    tall = marks["crown"][1] - eye
    front, side, nape = rng.uniform(0.2, 0.68), rng.uniform(-0.3, 0.35), rng.uniform(-1.1, -0.5)
    azimuths = (0.0, 35.0, 60.0, 75.0, 90.0, 112.0, 125.0, 180.0)
    shares = (front, front, front - 0.2, side, side, 0.1, nape, nape)
    jagged, seed = rng.uniform(0.0, 0.012), int(rng.integers(1 << 30))

    def keeps(at: Places) -> Bool[np.ndarray, " k"]:
        azimuth = np.degrees(np.arctan2(np.abs(at.x), at.z - ear))
        line = eye + tall * np.interp(azimuth, azimuths, shares)
        return at.y > line + jagged * noise(np.random.default_rng(seed), at.points, 0.02)

    return keeps


def _strands(colour: Rgb, rng: np.random.Generator) -> Paint:
    strong, seed = rng.uniform(0.1, 0.4), int(rng.integers(1 << 30))

    def paint(at: Places) -> Float[np.ndarray, "k 3"]:
        streaks = noise(np.random.default_rng(seed), at.points * np.array([1.0, 0.25, 1.0]), 0.012)
        return colour * np.exp(strong * streaks)[:, None]

    return paint


def _leather(sole: float, rng: np.random.Generator, *, two: bool) -> Paint:
    """A shoe of one colour or two above a sole."""
    first, second = cloth_colour(rng), cloth_colour(rng)
    below = np.full(3, rng.uniform(0.4, 0.8)) if rng.random() < 0.6 else cloth_colour(rng)
    seed = int(rng.integers(1 << 30))

    def paint(at: Places) -> Float[np.ndarray, "k 3"]:
        own = np.random.default_rng(seed)
        colours = np.repeat(first[None], len(at.x), axis=0)
        if two:
            colours[noise(own, at.points, 0.05) > 0.6] = second
        colours[at.y < sole] = below
        return colours * np.exp(0.1 * noise(own, at.points, 0.02))[:, None]

    return paint


def shod(
    body: StandingBody, ease_m: float, sole_m: float, rng: np.random.Generator, *, broad: bool
) -> Vertices:
    """Feet moved out, broader than they are, on a sole below them."""
    rest = body.rest
    vertices = moved_out(
        body, np.where(rest.on("foot"), ease_m, min(ease_m, 0.008)), rounds=2 if broad else 0
    )
    feet = rest.on("foot") & (rest.points[:, 1] < rest.marks["left_ankle"][1] - 0.02)
    for _, sign in SIDES:
        own = feet & (sign * rest.points[:, 0] > 0.0)
        middle = vertices[own].mean(axis=0)
        if broad:
            wider = np.array([rng.uniform(1.02, 1.12), 1.0, rng.uniform(1.0, 1.08)])
            vertices[own] = middle + (vertices[own] - middle) * wider
        vertices[own & (vertices[:, 1] < vertices[own, 1].min() + 0.03), 1] -= sole_m
    return vertices


def _loose(sheet: Sheet, paint: Paint, rank: float, gloss: float) -> Layer:
    return Layer(
        vertices=sheet.vertices,
        triangles=sheet.triangles,
        places=loose_places(sheet.vertices),
        part=WornPart.HAIR,
        paint=paint,
        rank=rank,
        gloss=gloss,
    )


def _within(
    points: Vertices, middle: Vector3, axes: Vector3 | tuple[float, float, float]
) -> Bool[np.ndarray, " k"]:
    return (((points - middle) / np.asarray(axes)) ** 2).sum(axis=1) < 1.0


def _unit(vector: Vector3) -> Vector3:
    return vector / np.linalg.norm(vector)
