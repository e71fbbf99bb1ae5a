"""A picture spoilt: blurred, in another light, rolled, cropped, reduced, with things in the way.

What stands before a person or beside them (a box, a table, a bag, an arm, somebody else) is placed
by the true joints, painted with a slope of light and grain, and blurred a little at its border.
"""

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import Mask
from fitter.observation.pixels import WORKING_PIXELS, display_from_linear, linear_from_display
from tests.accuracy.true_picture import TruePicture
from tests.accuracy.truth import part_of_joint

Picture = UInt8[np.ndarray, "h w 3"]

Point = Float[np.ndarray, "2"]

COLOURS = ((38, 40, 46), (96, 70, 48), (60, 84, 110), (128, 120, 108), (84, 30, 34), (46, 70, 50))
"""sRGB of things, one a seed."""

SLOPE, GRAIN, SOFTNESS_PX = 0.25, 2.0, 0.6
"""How much darker the lower end of a thing is, the noise in steps of 8-bit values, and the blur."""

ARM_RADIUS_M = 0.042

SHOULDER_SHARE = 0.35
"""How far between the near shoulder and the middle a neighbour in front reaches."""

ROLLED_SCALE = 0.85
"""A rolled picture is reduced so far that the person stays in it."""


def blurred(picture: Picture, *, deviation_px: float) -> Picture:
    """Blurred by so many pixels of the working picture."""
    height, width = picture.shape[:2]
    scale = max(1.0, (height * width / WORKING_PIXELS) ** 0.5)
    return cv2.GaussianBlur(picture, (0, 0), deviation_px * scale)


def exposed(picture: Picture, *, factor: float) -> Picture:
    """With so much of the light; less light has the noise of a short exposure."""
    light = factor * linear_from_display(picture / 255.0)
    rng = np.random.default_rng(picture.size)
    noise = rng.normal(0.0, 1.0, light.shape) * np.sqrt(1e-4 * light + 5e-8)
    return np.rint(255.0 * display_from_linear(np.clip(light + noise, 0.0, 1.0))).astype(np.uint8)


def rolled(picture: Picture, *, degrees: float) -> Picture:
    """As by a camera that was rolled; the border is repeated outward."""
    height, width = picture.shape[:2]
    turn = cv2.getRotationMatrix2D((width / 2, height / 2), degrees, ROLLED_SCALE)
    return cv2.warpAffine(
        picture, turn, (width, height), flags=cv2.INTER_AREA, borderMode=cv2.BORDER_REPLICATE
    )


def cropped(picture: Picture, person: Mask, *, bottom: float) -> Picture:
    """Down to a share of the person's height, from the top."""
    rows = np.flatnonzero(person.any(axis=1))
    return np.ascontiguousarray(picture[: rows[0] + round(bottom * len(rows))])


def reduced(picture: Picture, person: Mask, *, stature_px: float) -> Picture:
    """So small that the person has this many pixels."""
    rows = np.flatnonzero(person.any(axis=1))
    return _scaled(picture, stature_px / int(rows[-1] - rows[0] + 1))


def far_away(picture: Picture, person: Mask, *, stature_px: float) -> Picture:
    """As small as :func:`reduced`, in a picture of the working size, before a wall."""
    small = reduced(picture, person, stature_px=stature_px)
    side = round(WORKING_PIXELS**0.5)
    rows, columns = side - len(small), side - small.shape[1]
    return np.pad(
        small,
        ((rows // 2, rows - rows // 2), (columns // 2, columns - columns // 2), (0, 0)),
        mode="edge",
    )


def beside(picture: Picture, other: Picture) -> Picture:
    """Two pictures side by side, of the first one's height."""
    height = len(picture)
    return np.concatenate([picture, _scaled(other, height / len(other))[:height]], axis=1)


def _scaled(picture: Picture, factor: float) -> Picture:
    return cv2.resize(picture, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """A picture with its person, decoded, and somebody else's."""

    pixels: Picture
    true: TruePicture
    other_pixels: Picture
    other: TruePicture
    seed: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Spoilt:
    """A picture, and (h, w) where it hides what was there, so that it cannot be clicked."""

    pixels: Picture
    hidden: Mask


Occlude = Callable[[Scene], Spoilt]


def box_before_the_hips(scene: Scene) -> Spoilt:
    """A box, half as broad again as the waist, from the waist to the upper thighs."""
    hips, chest, knees = (_middle(scene.true, each) for each in ("hip", "shoulder", "knee"))
    waist = hips[1] - 0.35 * (hips[1] - chest[1])
    left, right = _trunk(scene.true.person_mask, round(waist), round(hips[0]))
    rim = 0.25 * (right - left)
    top = hips[1] - 0.28 * (hips[1] - chest[1])
    bottom = hips[1] + 0.3 * (knees[1] - hips[1])
    return _painted(scene, _box(scene, left - rim, top, right + rim, bottom))


def table_before_the_legs(scene: Scene) -> Spoilt:
    """A board right across the picture, from the middle of the thighs down to the shins."""
    hips, knees, ankles = (_middle(scene.true, each) for each in ("hip", "knee", "ankle"))
    top = hips[1] + 0.5 * (knees[1] - hips[1])
    bottom = knees[1] + 0.4 * (ankles[1] - knees[1])
    return _painted(scene, _box(scene, 0.0, top, float(scene.pixels.shape[1]), bottom))


def bag_beside_the_trunk(scene: Scene) -> Spoilt:
    """A bag at one side that hides the trunk's border there, from the ribs to the hip."""
    hips, chest = (_middle(scene.true, each) for each in ("hip", "shoulder"))
    tall = hips[1] - chest[1]
    side = -1.0 if scene.seed % 2 else 1.0
    half = abs(_joint(scene.true, "left_hip")[0] - _joint(scene.true, "right_hip")[0])
    centre = (hips[0] + 1.15 * side * half, hips[1] - 0.18 * tall)
    shape = np.zeros(scene.pixels.shape[:2], dtype=np.uint8)
    axes = (max(round(0.45 * half), 3), max(round(0.34 * tall), 3))
    cv2.ellipse(shape, (round(centre[0]), round(centre[1])), axes, 8.0 * side, 0, 360, 1, -1)
    return _painted(scene, shape > 0)


def arm_across_the_waist(scene: Scene) -> Spoilt:
    """An arm of the person's own colour that comes from beside them and lies before the waist."""
    hips, chest = (_middle(scene.true, each) for each in ("hip", "shoulder"))
    height = hips[1] - 0.42 * (hips[1] - chest[1])
    broad = abs(_joint(scene.true, "left_shoulder")[0] - _joint(scene.true, "right_shoulder")[0])
    side = -1.0 if scene.seed % 2 else 1.0
    start = hips[0] + side * 1.3 * broad, height + 0.12 * (hips[1] - chest[1])
    end = hips[0] - side * 0.28 * broad, height
    distance_m = float(scene.true.joints[part_of_joint("left_hip"), 2])
    radius = ARM_RADIUS_M * scene.true.focal_length_px / distance_m
    rows, columns = np.indices(scene.pixels.shape[:2]) + 0.5
    along = np.array(end) - np.array(start)
    share = ((columns - start[0]) * along[0] + (rows - start[1]) * along[1]) / (along @ along)
    share = np.clip(share, 0.0, 1.0)
    x, y = start[0] + share * along[0], start[1] + share * along[1]
    away = (rows - y) / radius
    shape = np.hypot(rows - y, columns - x) <= radius
    colour = _skin_colour(scene)
    # Lit from above, round.
    light = 1.0 - 0.3 * np.clip(away, -1.0, 1.0) - 0.25 * np.clip(away, -1.0, 1.0) ** 2
    return _laid_over(scene, shape, colour * light[..., None])


def neighbour_behind(scene: Scene) -> Spoilt:
    """Somebody else of the same height half behind the person."""
    pixels, mask = _neighbour(scene, overlapping=0.55)
    shown = mask & ~scene.true.person_mask
    return Spoilt(
        pixels=np.where(shown[..., None], pixels, scene.pixels),
        hidden=np.zeros_like(mask),
    )


def neighbour_in_front(scene: Scene) -> Spoilt:
    """Somebody else of the same height, who hides an arm of the person and a part of the trunk."""
    pixels, mask = _neighbour(scene, overlapping=SHOULDER_SHARE)
    return Spoilt(pixels=np.where(mask[..., None], pixels, scene.pixels), hidden=mask)


def _skin_colour(scene: Scene) -> Float[np.ndarray, "3"]:
    """Of the person's forearm, sRGB."""
    wrist, elbow = (_joint(scene.true, f"left_{each}") for each in ("wrist", "elbow"))
    column, row = np.rint(0.5 * (wrist + elbow)).astype(int)
    return np.median(scene.pixels[row - 2 : row + 3, column - 2 : column + 3], axis=(0, 1))


def _neighbour(scene: Scene, *, overlapping: float) -> tuple[Picture, Mask]:
    """Somebody else of the person's height, beside them.

    ``overlapping`` is how far their border reaches from a shoulder to the middle of the trunk.
    """
    side = "right" if scene.seed % 2 else "left"
    to = _joint(scene.true, f"{side}_shoulder"), _middle(scene.true, "hip")
    border = to[0][0] + overlapping * (to[1][0] - to[0][0])
    own, others = _rows(scene.true.person_mask), _rows(scene.other.person_mask)
    scale = (own[1] - own[0]) / (others[1] - others[0])
    # Their trunk, not their hand, is to be near: measured between shoulders and hips.
    first, last = (scale * _middle(scene.other, each)[1] for each in ("shoulder", "hip"))
    size = tuple(round(scale * each) for each in scene.other_pixels.shape[1::-1])
    shown = cv2.resize(scene.other_pixels, size, interpolation=cv2.INTER_AREA)
    mask = cv2.resize(scene.other.person_mask.astype(np.uint8), size) > 0
    columns = np.flatnonzero(mask[round(first) : round(last)].mean(axis=0) > 0.5)
    right_of = border > to[1][0]
    across = border - float(columns[0] if right_of else columns[-1] + 1)
    down = own[0] - scale * others[0]
    moved = np.array([[1.0, 0.0, across], [0.0, 1.0, down]])
    height, width = scene.pixels.shape[:2]
    pixels = cv2.warpAffine(shown, moved, (width, height))
    return pixels, cv2.warpAffine(mask.astype(np.uint8), moved, (width, height)) > 0


def _painted(scene: Scene, shape: Mask) -> Spoilt:
    rows = np.arange(scene.pixels.shape[0])
    first, last = _rows(shape)
    slope = 1.0 - SLOPE * (np.clip(rows, first, last) - first) / max(last - first, 1)
    colour = np.array(COLOURS[scene.seed % len(COLOURS)], dtype=float)
    return _laid_over(scene, shape, np.multiply.outer(slope, colour)[:, None])


def _laid_over(scene: Scene, shape: Mask, colours: np.ndarray) -> Spoilt:
    share = cv2.GaussianBlur(shape.astype(np.float32), (0, 0), SOFTNESS_PX)[..., None]
    grain = np.random.default_rng(scene.seed).normal(0.0, GRAIN, scene.pixels.shape)
    laid = (1.0 - share) * scene.pixels + share * (colours + grain)
    return Spoilt(pixels=np.rint(np.clip(laid, 0, 255)).astype(np.uint8), hidden=shape)


def _box(scene: Scene, left: float, top: float, right: float, bottom: float) -> Mask:
    shape = np.zeros(scene.pixels.shape[:2], dtype=np.bool_)
    first_row, first_column = max(round(top), 0), max(round(left), 0)
    shape[first_row : round(bottom), first_column : round(right)] = True
    return shape


def _joint(true: TruePicture, name: str) -> Point:
    """Where a joint is in the picture as it was sent."""
    x, y, z = true.joints[part_of_joint(name)]
    height, width = true.person_mask.shape
    return np.array([width, height]) / 2 + true.focal_length_px * np.array([x, y]) / z


def _middle(true: TruePicture, name: str) -> Point:
    return 0.5 * (_joint(true, f"left_{name}") + _joint(true, f"right_{name}"))


def _trunk(mask: Mask, row: int, middle: int) -> tuple[float, float]:
    """First column and that after the last of what is connected with the middle in a row."""
    before, after = np.flatnonzero(~mask[row, :middle]), np.flatnonzero(~mask[row, middle:])
    return float(before[-1] + 1 if len(before) else 0), float(
        middle + after[0] if len(after) else mask.shape[1]
    )


def _rows(mask: Mask) -> tuple[int, int]:
    rows = np.flatnonzero(mask.any(axis=1))
    return int(rows[0]), int(rows[-1] + 1)
