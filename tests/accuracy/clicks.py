"""Clicks as a person would make them: true points, what hides them, an unsteady hand."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.render.rasterizer import Rendering
from fitter.vocabulary.points import FACE_POINT_NAMES, LIMB_POINT_NAMES
from tests.accuracy.people import INNER_POINT_BONES, landmarks_on
from tests.accuracy.staging import Staged

CLICK_DEVIATION_PX = 2.5

SURFACE_POINTS = (*FACE_POINT_NAMES, "neck", "head_top", "chin")

SEEN_WITHIN_M = 0.015
"""A point of the surface is seen if nothing lies farther than this before it."""

INSIDE_WITHIN_M: Mapping[str, float] = {
    "shoulder": 0.11, "elbow": 0.09, "wrist": 0.07, "hip": 0.2, "knee": 0.11, "ankle": 0.1,
}  # fmt: skip
"""A joint lies under this much of its own limb at most; what is nearer to the camera hides it."""

Points = dict[str, Float[np.ndarray, "3"]]


def true_points(staged: Staged) -> Points:
    """Where the points people click truly are, camera frame, metres: the rig's joints inside the
    body, the body model's landmarks on its surface."""
    marks = landmarks_on(staged.person.gender, staged.body)
    world = {name: marks[name] for name in SURFACE_POINTS}
    for name in LIMB_POINT_NAMES:
        side, joint = name.split("_")
        world[name] = staged.bones[f"{INNER_POINT_BONES[joint]}.{side[0].upper()}"]
    return {name: staged.in_camera(point) for name, point in world.items()}


def noisy_clicks(
    staged: Staged, seen: Rendering, rng: np.random.Generator
) -> dict[str, dict[str, float | int]]:
    """Clicks by name as a request holds them: ``visibility`` 2, or 1 where guessed.

    Hidden points of the surface are left out, as are points beyond the picture.
    """
    clicks: dict[str, dict[str, float | int]] = {}
    camera = staged.camera
    for name, point in true_points(staged).items():
        place = camera.project(point)
        x, y = place + CLICK_DEVIATION_PX * rng.normal(size=2)
        if not (0.0 <= x <= camera.width and 0.0 <= y <= camera.height):
            continue
        visible = _visible(name, point, place, seen)
        if visible or name not in SURFACE_POINTS:
            clicks[name] = {
                "x": round(float(x), 1),
                "y": round(float(y), 1),
                "visibility": 2 if visible else 1,
            }
    return clicks


def hidden_points(staged: Staged, seen: Rendering) -> list[str]:
    """Points that the body itself hides, whether or not they are clicked."""
    return [
        name
        for name, point in true_points(staged).items()
        if not _visible(name, point, staged.camera.project(point), seen)
    ]


def _visible(
    name: str, point: Float[np.ndarray, "3"], place: Float[np.ndarray, "2"], seen: Rendering
) -> bool:
    row = min(max(int(place[1]), 0), seen.camera.height - 1)
    column = min(max(int(place[0]), 0), seen.camera.width - 1)
    before = float(point[2] - seen.depth[row, column])
    inside = SEEN_WITHIN_M if name in SURFACE_POINTS else INSIDE_WITHIN_M[name.split("_")[1]]
    return before < inside
