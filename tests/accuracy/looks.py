"""Skin, hair and clothes: colours and reliefs painted on a refined body at rest.

Places are found from the person's own landmarks at rest, so that one description suits all.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Float, Integer
from PIL import Image as PillowImage

from fitter.arrays import Vertices
from fitter.training.dressed.surfaces import smooth_step
from fitter.training.makehuman.meshes import makehuman_folder
from fitter.vocabulary.choices import Gender
from tests.accuracy.noise import value_noise
from tests.accuracy.scene import Hair, Label, Look

Landmarks = Mapping[str, Float[np.ndarray, "3"]]

SKIN_ROUGHNESS = 0.48
HAIR_ROUGHNESS = 0.5
CLOTH_ROUGHNESS = 0.9

CLOTH_EDGE_M = 0.003
HAIR_RISE_M = 0.02
HAIR_RELIEF_M: Mapping[Hair, float] = {Hair.SHORT: 0.016, Hair.TIED: 0.009, Hair.SHAVED: 0.001}

HAIRLINE_DEGREES = (0.0, 30.0, 50.0, 62.0, 76.0, 84.0, 112.0, 122.0, 180.0)
HAIRLINE_SHARE = (0.56, 0.54, 0.47, 0.2, -0.05, 0.16, 0.16, -0.6, -0.95)
"""The lower edge of the hair by azimuth about the head, 0 in front: height above the eyes as a
share of the distance from eyes to crown."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Painted:
    """Per vertex of the refined body.

    Attributes
    ----------
    albedo
        (k, 3) linear.
    roughness
        (k,) of the gloss.
    relief_m
        (k,) how far the surface is pushed out along its normal.
    labels
        (k,) skin, hair or, of underwear, the garment.
    """

    albedo: Float[np.ndarray, "k 3"]
    roughness: Float[np.ndarray, " k"]
    relief_m: Float[np.ndarray, " k"]
    labels: Integer[np.ndarray, " k"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Canvas:
    """Where the vertices of the refined body lie.

    ``rest`` (k, 3) on the person at rest, ``uv`` (k, 2) in MakeHuman's texture, ``trunk`` (k,)
    how far they follow the trunk and ``legs`` the thighs, in [0, 1].
    """

    rest: Vertices
    uv: Float[np.ndarray, "k 2"]
    trunk: Float[np.ndarray, " k"]
    legs: Float[np.ndarray, " k"]


def paint(
    canvas: Canvas, points: Landmarks, gender: Gender, look: Look, rng: np.random.Generator
) -> Painted:
    """Paint a person."""
    skin = _skin(canvas, points, gender, look, rng)
    strands = _strands(canvas.rest, points, rng)
    above_hairline = _above_hairline(canvas, points) + 0.003 * strands
    cover = smooth_step(above_hairline, -0.001, 0.005)
    cloth = _cloth(canvas, points, gender)
    hair_albedo = np.array(look.hair_colour) * np.exp(0.3 * strands)[:, None]
    weave = 1.0 + 0.06 * value_noise(rng, canvas.rest / 0.02)
    cloth_albedo = np.array(look.clothes_colour) * weave[:, None]
    if look.hair is Hair.SHAVED:
        hair_albedo = 0.55 * skin + 0.45 * hair_albedo
    albedo = skin + cover[:, None] * (hair_albedo - skin)
    albedo += cloth[:, None] * (cloth_albedo - albedo)
    roughness = SKIN_ROUGHNESS + cover * (HAIR_ROUGHNESS - SKIN_ROUGHNESS)
    roughness += cloth * (CLOTH_ROUGHNESS - roughness)
    volume = HAIR_RELIEF_M[look.hair] * smooth_step(above_hairline, 0.0, HAIR_RISE_M)
    folds = 1.0 + 0.25 * value_noise(rng, canvas.rest / np.array([0.05, 0.02, 0.05]))
    labels = np.where(cover > 0.5, Label.HAIR, Label.SKIN)
    above_waist = canvas.rest[:, 1] > points["navel"][1]
    labels[cloth > 0.5] = np.where(above_waist, Label.UPPER, Label.LOWER)[cloth > 0.5]
    return Painted(
        albedo=np.clip(albedo, 0.003, 0.9),
        roughness=roughness,
        relief_m=volume * (1.0 + 0.05 * strands) + cloth * look.clothes_relief_m * folds,
        labels=labels,
    )


def _skin(
    canvas: Canvas, points: Landmarks, gender: Gender, look: Look, rng: np.random.Generator
) -> Float[np.ndarray, "k 3"]:
    rest = canvas.rest
    blotches = value_noise(rng, rest / 0.09)
    pores = value_noise(rng, rest / 0.012)
    skin = np.array(look.skin) * np.exp(0.045 * blotches + 0.025 * pores)[:, None]
    redder = np.array([1.0, 0.86, 0.84])
    flush = 0.5 * _cheeks(rest, points) + 0.35 * _joints(rest, points)
    skin *= 1.0 + np.clip(flush, 0.0, 1.0)[:, None] * (redder - 1.0)
    lips = 0.8 * _mask("mpfb_lips", canvas.uv)
    skin *= 1.0 + lips[:, None] * (np.array([0.78, 0.5, 0.5]) - 1.0)
    if gender is Gender.MALE:
        areola = 0.8 * _mask("mpfb_aureolae", canvas.uv)
        skin *= 1.0 + areola[:, None] * (np.array([0.7, 0.48, 0.42]) - 1.0)
        beard = 0.22 * _beard(rest, points)
        skin *= 1.0 - beard[:, None] * np.array([1.0, 0.9, 0.8])
    brows = 0.75 * _brows(rest, points, gender)
    return skin + brows[:, None] * (np.array(look.hair_colour) * 1.2 - skin)


def _cheeks(rest: Vertices, points: Landmarks) -> Float[np.ndarray, " k"]:
    total = np.zeros(len(rest))
    for side in ("left", "right"):
        eye, nose = points[f"{side}_eye"], points["nose"]
        cheek = np.array([1.1 * eye[0], nose[1] - 0.005, eye[2] - 0.005])
        total += np.exp(-0.5 * (np.linalg.norm(rest - cheek, axis=1) / 0.018) ** 2)
    return total


def _joints(rest: Vertices, points: Landmarks) -> Float[np.ndarray, " k"]:
    total = np.zeros(len(rest))
    for side in ("left", "right"):
        for name, width in (("elbow", 0.05), ("knee", 0.06), ("finger_tip", 0.06)):
            away = np.linalg.norm(rest - points[f"{side}_{name}"], axis=1)
            total += np.exp(-0.5 * (away / width) ** 2)
    return total


def _brows(rest: Vertices, points: Landmarks, gender: Gender) -> Float[np.ndarray, " k"]:
    height = 0.0035 if gender is Gender.MALE else 0.0022
    total = np.zeros(len(rest))
    for side in ("left", "right"):
        eye = points[f"{side}_eye"]
        along = np.abs(rest[:, 0]) - abs(eye[0])
        arch = eye[1] + 0.021 + 0.003 * np.cos(along / 0.02) - 0.12 * np.maximum(along, 0.0)
        same_side = rest[:, 0] * eye[0] > 0.0
        in_front = rest[:, 2] > eye[2] - 0.03
        level = np.exp(-0.5 * ((rest[:, 1] - arch) / height) ** 2)
        span = smooth_step(along, -0.024, -0.016) * smooth_step(-along, -0.026, -0.012)
        total += same_side * in_front * level * span
    return total


def _beard(rest: Vertices, points: Landmarks) -> Float[np.ndarray, " k"]:
    chin, nose, neck = points["chin"], points["nose"], points["neck"]
    ear = points["left_ear"]
    below = smooth_step(-(rest[:, 1] - (nose[1] - 0.012)), -0.004, 0.008)
    above = smooth_step(rest[:, 1], 0.6 * chin[1] + 0.4 * neck[1], chin[1])
    front = smooth_step(rest[:, 2], ear[2] - 0.005, ear[2] + 0.02)
    return below * above * front * (np.abs(rest[:, 0]) < 0.1)


def _above_hairline(canvas: Canvas, points: Landmarks) -> Float[np.ndarray, " k"]:
    """Metres above the lower edge of the hair; far below it where no hair grows."""
    rest = canvas.rest
    eye_height = 0.5 * (points["left_eye"] + points["right_eye"])[1]
    ear = 0.5 * (points["left_ear"] + points["right_ear"])
    tall = points["crown"][1] - eye_height
    azimuth = np.degrees(np.arctan2(np.abs(rest[:, 0]), rest[:, 2] - ear[2]))
    line = eye_height + tall * np.interp(azimuth, HAIRLINE_DEGREES, HAIRLINE_SHARE)
    on_scalp = (rest[:, 1] > points["neck"][1]) & (_mask("mpfb_ears", canvas.uv) < 0.5)
    return np.where(on_scalp, rest[:, 1] - line, -1.0)


def _strands(
    rest: Vertices, points: Landmarks, rng: np.random.Generator
) -> Float[np.ndarray, " k"]:
    """Streaks that run from the forehead over the crown to the nape."""
    ear = 0.5 * (points["left_ear"] + points["right_ear"])
    away = rest - ear
    along = np.arctan2(away[:, 1], away[:, 2])
    across = np.arctan2(away[:, 0], np.hypot(away[:, 1], away[:, 2]))
    return value_noise(rng, np.stack([1.5 * along, 45.0 * across], axis=1), octaves=2)


def _cloth(canvas: Canvas, points: Landmarks, gender: Gender) -> Float[np.ndarray, " k"]:
    rest, edge = canvas.rest, CLOTH_EDGE_M
    navel, crotch = points["navel"][1], points["crotch"][1]
    lower_body = (canvas.trunk + canvas.legs) > 0.5
    aside, height = np.abs(rest[:, 0]), rest[:, 1]
    if gender is Gender.MALE:
        waistband, leg = navel - 0.35 * (navel - crotch), crotch - 0.075
        shorts = smooth_step(waistband - height, 0.0, edge) * smooth_step(height - leg, 0.0, edge)
        return shorts * lower_body
    waistband = navel - 0.42 * (navel - crotch)
    leg = crotch - 0.01 + 0.55 * np.maximum(aside - 0.03, 0.0)
    briefs = smooth_step(waistband - height, 0.0, edge) * smooth_step(height - leg, 0.0, edge)
    bust = points["left_nipple"]
    under, over = bust[1] - 0.085, bust[1] + 0.055
    band = smooth_step(height - under, 0.0, edge) * smooth_step(over - height, 0.0, edge)
    return np.maximum(briefs * lower_body, band * (canvas.trunk > 0.6))


def _mask(name: str, uv: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, " k"]:
    """One of MakeHuman's texture masks (CC0) at texture coordinates, in [0, 1]."""
    picture = _mask_picture(name)
    height, width = picture.shape
    column = np.clip((uv[:, 0] * width).astype(int), 0, width - 1)
    row = np.clip(((1.0 - uv[:, 1]) * height).astype(int), 0, height - 1)
    return picture[row, column]


@cache
def _mask_picture(name: str) -> Float[np.ndarray, "h w"]:
    with PillowImage.open(makehuman_folder() / "textures" / f"{name}.jpg") as picture:
        return np.asarray(picture.convert("L"), dtype=float) / 255.0
