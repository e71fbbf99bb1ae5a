"""Clothes as close as paint: foreign people in underwear, with shirts and leggings drawn on them.

Where the outline stays the body's own, saying nothing of clothes must cost nothing.
"""

from collections.abc import Sequence
from dataclasses import replace
from io import BytesIO

import cv2
import numpy as np
from jaxtyping import Shaped
from PIL import Image as PillowImage

from fitter.observation.pixels import display_from_linear, linear_from_display, luminance_of
from fitter.render.rasterizer import render
from fitter.vocabulary.choices import Clothing, Cues
from tests.accuracy.foreign import foreign_names, foreign_picture
from tests.accuracy.landmark_points import packaged_model
from tests.accuracy.scene import Series
from tests.accuracy.scoring import fit_picture
from tests.accuracy.true_picture import Told, TruePicture
from tests.one_picture import changed

PREFIX = "painted-"

GARMENTS: Sequence[tuple[frozenset[str], float]] = (
    (frozenset({"chest", "spine", "pelvis", "arm"}), 0.5),
    (frozenset({"thigh", "shin"}), 0.3),
)
"""A shirt and leggings: the kinds of parts that they cover, and how light they are at most."""

DARKEST = 0.03
GRAIN = 0.05
"""Texture of the cloth, relative to its light."""


def painted_names() -> list[str]:
    """The pictures; none where the foreign ones are not beside the repository."""
    return [f"{PREFIX}{name}" for name in foreign_names()]


def painted_picture(name: str) -> TruePicture:
    """The foreign picture of this name in other colours; shading of folds and lamps stays."""
    picture = foreign_picture(name.removeprefix(PREFIX))
    kinds = _kinds(picture)
    values = np.asarray(PillowImage.open(BytesIO(picture.request.views[0].image)).convert("RGB"))
    linear = linear_from_display(values.astype(np.float64) / 255.0)
    light = luminance_of(linear)
    # The same colours in every run, others for every person.
    random = np.random.default_rng(list(name.encode()))
    for covered, lightest in GARMENTS:
        on = np.isin(kinds, list(covered)) & picture.person_mask
        colour = random.uniform(DARKEST, lightest, 3)
        grain = 1.0 + GRAIN * random.standard_normal(np.count_nonzero(on))
        linear[on] = (light[on] / np.median(light[on]) * grain)[:, None] * colour
    painted = np.rint(255.0 * display_from_linear(np.clip(linear, 0.0, 1.0))).astype(np.uint8)
    file = BytesIO()
    PillowImage.fromarray(painted).save(file, "PNG")
    request = changed(
        picture.request,
        image=file.getvalue(),
        # A painted file has no EXIF.
        focal_length_px=picture.focal_length_px,
        focal_length_35mm=None,
    )
    return replace(picture, name=name, series=Series.PAINTED, request=request)


def _kinds(picture: TruePicture) -> Shaped[np.ndarray, "h w"]:
    """(h, w) the kind of part that each pixel shows or is nearest to, by a fit in underwear."""
    person = fit_picture(picture, Cues.SE, Told(clothing=Clothing.TIGHT)).result
    model = packaged_model(picture.request.person.gender)
    faces = render(person.found.posed_vertices, model.triangles, person.person.camera).face_ids
    names = np.array([part.rpartition("_")[2] for part in model.part_names])
    shown = faces >= 0
    _, labels = cv2.distanceTransformWithLabels(
        (~shown).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    nearest = labels.astype(int)
    face_of_label = np.zeros(nearest.max() + 1, dtype=int)
    face_of_label[nearest[shown]] = faces[shown]
    return names[model.part_of_triangle[face_of_label[nearest]]]
