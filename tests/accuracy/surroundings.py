"""Textures of wall and floor, made here: linear albedo pictures and their size in metres."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.training.dressed.surfaces import smooth_step
from tests.accuracy.noise import value_noise
from tests.accuracy.scene import Floor, Rgb, Surroundings, Wall

PIXELS_PER_METRE = 250
WALL_SIZE_M = (5.0, 3.6)
FLOOR_SIZE_M = (5.0, 6.0)

Texture = Float[np.ndarray, "h w 3"]
Grid = Float[np.ndarray, "h w"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Sheet:
    """Metres from the left and from the bottom edge at every pixel; rows run downward."""

    x: Grid
    y: Grid

    def noise(
        self, rng: np.random.Generator, metres: tuple[float, float], octaves: int = 3
    ) -> Grid:
        """Noise with features of a size."""
        points = np.stack([self.x.ravel() / metres[0], self.y.ravel() / metres[1]], axis=1)
        return value_noise(rng, points, octaves=octaves).reshape(self.x.shape)


def wall_texture(surroundings: Surroundings, rng: np.random.Generator) -> Texture:
    """The wall's albedo."""
    sheet = _sheet(WALL_SIZE_M)
    paint = {
        Wall.CANVAS: _canvas,
        Wall.PLASTER: _plaster,
        Wall.BRICK: _brick,
        Wall.BOARDS: _boards,
        Wall.STRIPES: _stripes,
        Wall.SHELVES: _shelves,
        Wall.HEDGE: _hedge,
    }[surroundings.wall]
    texture = paint(sheet, surroundings.wall_colour, rng)
    return np.clip(texture, 0.01, 0.9)


def floor_texture(surroundings: Surroundings, rng: np.random.Generator) -> Texture:
    """The floor's albedo."""
    paint = {
        Floor.CONCRETE: _concrete,
        Floor.WOOD: _wood,
        Floor.CARPET: _carpet,
        Floor.GRASS: _grass,
    }
    sheet = _sheet(FLOOR_SIZE_M)
    return np.clip(paint[surroundings.floor](sheet, surroundings.floor_colour, rng), 0.01, 0.9)


def _canvas(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    """A painter's backdrop: clouds, lighter behind the person, and a faint weave."""
    clouds = 0.13 * sheet.noise(rng, (0.7, 0.8)) + 0.05 * sheet.noise(rng, (0.15, 0.2))
    middle = np.hypot(sheet.x - WALL_SIZE_M[0] / 2.0, 0.8 * (sheet.y - 1.3))
    glow = 0.35 * np.exp(-0.5 * (middle / 0.9) ** 2)
    weave = 0.02 * sheet.noise(rng, (0.02, 0.012), 1)
    warmth = 0.04 * sheet.noise(rng, (0.5, 0.5))
    tint = np.stack([1.0 + warmth, np.ones_like(warmth), 1.0 - warmth], axis=-1)
    return np.array(colour) * tint * np.exp(clouds + glow + weave)[..., None]


def _plaster(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    stains = 0.035 * sheet.noise(rng, (0.9, 0.6)) + 0.02 * sheet.noise(rng, (0.04, 0.04), 2)
    return np.array(colour) * np.exp(stains)[..., None]


def _brick(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    length, height, joint = 0.25, 0.078, 0.006
    course = np.floor(sheet.y / height)
    shifted = sheet.x / length + 0.5 * (course % 2)
    number = (course * 97 + np.floor(shifted)).astype(int)
    shades = rng.normal(size=number.max() + 1)[number]
    wander = 0.002 * sheet.noise(rng, (0.03, 0.03), 2)
    to_edge = np.minimum(
        length * np.minimum(shifted % 1.0, 1.0 - shifted % 1.0),
        height * np.minimum((sheet.y / height) % 1.0, 1.0 - (sheet.y / height) % 1.0),
    )
    brick = smooth_step(to_edge + wander, joint - 0.002, joint + 0.002)[..., None]
    grain = 0.08 * sheet.noise(rng, (0.02, 0.02))
    face = np.array(colour) * np.exp(0.14 * shades + grain)[..., None]
    mortar = np.full(3, 0.35) * np.exp(0.06 * sheet.noise(rng, (0.02, 0.02)))[..., None]
    return mortar + brick * (face - mortar)


def _boards(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    return _planks(sheet.x, sheet.y, sheet, colour, rng, width=0.14)


def _stripes(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    """Striped wallpaper: every other stripe darker, with a narrow line along it."""
    width, edge = 0.11, 0.002
    across = (sheet.x / width) % 2.0
    dark = smooth_step(0.5 - np.abs(across - 1.0), -edge / width, edge / width)
    line = smooth_step(0.06 - np.abs(across - 1.0), -edge / width, edge / width)
    paper = np.exp(0.02 * sheet.noise(rng, (0.5, 0.5)) + 0.03 * sheet.noise(rng, (0.01, 0.01), 2))
    return np.array(colour) * (paper * (1.0 - 0.45 * dark + 0.3 * line))[..., None]


def _shelves(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    """Rows of books of all colours, skin's among them, between boards."""
    row_height, board, width = 0.34, 0.03, 0.045
    row = np.floor(sheet.y / row_height).astype(int)
    up = sheet.y - row_height * row
    shelf = np.floor(sheet.x / width + 7.3 * row).astype(int)
    book = shelf - shelf.min()
    count = int(book.max()) + 1
    tops = rng.uniform(0.2, 0.29, count)[book]
    faces = rng.uniform(0.03, 0.5, (count, 1)) * rng.uniform(0.3, 1.0, (count, 3))
    shine = np.sqrt(np.clip(np.abs(np.sin(np.pi * (sheet.x / width + 7.3 * row))), 0.05, 1.0))
    title = (np.abs(up - 0.16) < rng.uniform(0.0, 0.05, count)[book]) & (shine > 0.85)
    books = faces[book] * shine[..., None]
    books = np.where(title[..., None], 0.5, books)
    behind = np.full(3, 0.02)
    shelves = np.where((up < tops)[..., None], books, behind)
    grain = np.exp(0.08 * sheet.noise(rng, (0.3, 0.01)))[..., None]
    return np.where((up > row_height - board)[..., None], np.array(colour) * grain, shelves)


def _hedge(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    """Leaves, lit and in shade."""
    leaves = 0.55 * sheet.noise(rng, (0.03, 0.025), 2) + 0.3 * sheet.noise(rng, (0.25, 0.2))
    yellow = 0.15 * sheet.noise(rng, (0.06, 0.06), 1)
    tint = np.stack([1.0 + yellow, np.ones_like(yellow), 1.0 - yellow], axis=-1)
    return np.array(colour) * tint * np.exp(leaves)[..., None]


def _grass(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    blades = 0.4 * sheet.noise(rng, (0.008, 0.03), 2) + 0.15 * sheet.noise(rng, (0.5, 0.5))
    return np.array(colour) * np.exp(blades)[..., None]


def _wood(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    return _planks(sheet.x, sheet.y, sheet, colour, rng, width=0.11)


def _planks(
    across: Grid,
    along: Grid,
    sheet: _Sheet,
    colour: Rgb,
    rng: np.random.Generator,
    *,
    width: float,
) -> Texture:
    number = np.floor(across / width).astype(int)
    shades = 0.12 * rng.normal(size=number.max() + 1)[number]
    offset = 13.0 * rng.random(number.max() + 1)[number]
    points = np.stack([across.ravel() / 0.008, (along + offset).ravel() / 0.5], axis=1)
    grain = 0.09 * value_noise(rng, points).reshape(across.shape)
    to_edge = width * np.minimum((across / width) % 1.0, 1.0 - (across / width) % 1.0)
    gap = 1.0 - 0.6 * smooth_step(-to_edge, -0.004, -0.001)
    return np.array(colour) * (np.exp(shades + grain) * gap)[..., None]


def _concrete(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    mottled = 0.08 * sheet.noise(rng, (0.5, 0.5)) + 0.05 * sheet.noise(rng, (0.05, 0.05))
    return np.array(colour) * np.exp(mottled)[..., None]


def _carpet(sheet: _Sheet, colour: Rgb, rng: np.random.Generator) -> Texture:
    pile = 0.12 * sheet.noise(rng, (0.012, 0.012), 2) + 0.04 * sheet.noise(rng, (0.4, 0.4))
    return np.array(colour) * np.exp(pile)[..., None]


def _sheet(size_m: tuple[float, float]) -> _Sheet:
    width, height = (round(metres * PIXELS_PER_METRE) for metres in size_m)
    x = (np.arange(width) + 0.5) / PIXELS_PER_METRE
    y = (height - np.arange(height) - 0.5) / PIXELS_PER_METRE
    grid_x, grid_y = np.meshgrid(x, y)
    return _Sheet(x=grid_x, y=grid_y)
