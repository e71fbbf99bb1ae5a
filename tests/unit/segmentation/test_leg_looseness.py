"""Trousers told from leggings by how far the outline is off the bones, on drawn legs."""

import numpy as np
import pytest

from fitter.segmentation.leg_looseness import legs_are_loose

PIXELS_PER_METRE = 200.0
HIPS_M, HIP_HEIGHT_M, KNEE_HEIGHT_M, ANKLE_HEIGHT_M = 0.2, 0.9, 0.5, 0.1
HEIGHT, WIDTH = 240, 240
MIDDLE = 120.0


def row(height_m: float) -> float:
    return 220.0 - PIXELS_PER_METRE * height_m


def joints() -> dict[str, np.ndarray]:
    found: dict[str, np.ndarray] = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        column = MIDDLE + 0.5 * sign * HIPS_M * PIXELS_PER_METRE
        for part, height in (
            ("thigh", HIP_HEIGHT_M),
            ("shin", KNEE_HEIGHT_M),
            ("foot", ANKLE_HEIGHT_M),
        ):
            found[f"{side}_{part}"] = np.array([column, row(height)])
    return found


def legs(thigh_m: float, shin_m: float) -> np.ndarray:
    """Two legs of boxes, as wide on either side of the bone."""
    mask = np.zeros((HEIGHT, WIDTH), dtype=bool)
    for each in ("left", "right"):
        column = joints()[f"{each}_thigh"][0]
        for top, bottom, half in (
            (HIP_HEIGHT_M, KNEE_HEIGHT_M, thigh_m),
            (KNEE_HEIGHT_M, ANKLE_HEIGHT_M, shin_m),
        ):
            first, last = (round(column + sign * half * PIXELS_PER_METRE) for sign in (-1, 1))
            mask[round(row(top)) : round(row(bottom)), first:last] = True
    return mask


def loose(mask: np.ndarray, *, bare_below_m: float = 0.0) -> float:
    bare = np.zeros(mask.shape, dtype=np.float32)
    bare[round(row(bare_below_m)) :] = 1.0
    return legs_are_loose(mask, bare, joints(), PIXELS_PER_METRE)


def test_leggings_are_close():
    assert loose(legs(0.065, 0.03)) < 0.1


def test_trousers_are_loose():
    assert loose(legs(0.095, 0.08)) > 0.95


def test_legs_beyond_the_picture_are_not_thin():
    assert loose(legs(0.065, 0.03)[: round(row(0.7))]) == pytest.approx(0.8)


def test_a_wide_skirt_above_bare_shins_is_loose():
    assert loose(legs(0.19, 0.03), bare_below_m=KNEE_HEIGHT_M) > 0.95


def test_bare_shins_say_nothing_of_shorts():
    thin, thick = (loose(legs(0.08, shin), bare_below_m=KNEE_HEIGHT_M) for shin in (0.025, 0.07))
    assert thin == pytest.approx(thick)


def test_legs_that_point_at_the_camera_leave_what_is_usual():
    folded = {name: np.array([place[0], row(0.9)]) for name, place in joints().items()}
    mask = legs(0.065, 0.03)
    found = legs_are_loose(mask, np.zeros(mask.shape, np.float32), folded, PIXELS_PER_METRE)
    assert found == pytest.approx(0.8)
