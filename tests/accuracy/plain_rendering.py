"""People of the suite as our own rasteriser shows them, turned: no hair, no clothes but colour.

For questions to a detector that need no photograph, such as from where somebody is seen.
"""

from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.observation.pixels import display_from_linear
from tests.accuracy.clicks import rendering
from tests.accuracy.people import load_person, rig_of_people
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Case
from tests.accuracy.staging import stage

TO_LIGHT = np.array([-0.5, -0.6, -0.6]) / np.linalg.norm([-0.5, -0.6, -0.6])
AMBIENT, DIFFUSE = 0.2, 0.7
SKIN, CLOTH, WALL = (0.5, 0.3, 0.22), (0.1, 0.12, 0.3), 0.25
CLOTHED = (0.44, 0.54)
"""Between these shares of the height above the floor people wear shorts."""

_SOFTNESS_PX, _NOISE = 0.6, 0.003


def plain_picture(case: Case, *, turned_deg: float) -> UInt8[np.ndarray, "h w 3"]:
    """A case's person, turned about the upright axis from how they stand there; sRGB."""
    stance = replace(case.stance, facing=case.stance.facing + turned_deg)
    staged = stage(load_person(PEOPLE[case.person]), replace(case, stance=stance))
    faces, triangles = rendering(staged).face_ids, rig_of_people().surface.triangles
    corners = staged.in_camera(staged.body)[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    heights = staged.body[triangles].mean(axis=1)[:, 1] - staged.body[:, 1].min()
    shares = heights / np.ptp(staged.body[:, 1])
    clothed = (shares > CLOTHED[0]) & (shares < CLOTHED[1])
    light = AMBIENT + DIFFUSE * np.clip(normals @ TO_LIGHT, 0.0, 1.0)
    colours = np.where(clothed[:, None], CLOTH, SKIN) * light[:, None]
    shown = np.where((faces >= 0)[..., None], colours[faces], WALL)
    noise = np.random.default_rng(case.seed).normal(0.0, _NOISE, shown.shape)
    soft = cv2.GaussianBlur(shown, (0, 0), _SOFTNESS_PX) + noise
    return np.rint(255.0 * display_from_linear(np.clip(soft, 0.0, 1.0))).astype(np.uint8)
