"""The outline of a person in loose clothes, found from the contour of a body inside it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage, Mask, PerVertex, Points2D
from fitter.evidence.silhouette_evidence import FullnessMap
from fitter.observation.maps import sample
from fitter.render.rasterizer import Rendering

FARTHEST_M, INWARD_M = 0.18, 0.05
"""Distances outside and inside a body's contour within which the clothes' outline is sought."""

WITHIN_M = 0.01
"""Depth inside a boundary at which cloth is looked for: the rim itself is mixed."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LooseClothes:
    """Knowledge of the clothes of a person said to wear loose ones.

    Attributes
    ----------
    bare
        (m,) probability that no clothes hide a vertex, from a body near the person.
    learnt_from
        What the skin's colour was learnt from: ``face``, ``hands``, or nothing.
    looks_undressed
        Whether the person seems to wear no more than underwear.
    over_top
        Whether something is worn over a top; None where that is not known.
    """

    bare: PerVertex
    learnt_from: tuple[str, ...]
    looks_undressed: bool
    over_top: bool | None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LooseOutline:
    """The outline of the clothes.

    ``mask`` (h, w) is the segmented person, ``cloth`` (h, w) the probability of loose cloth,
    ``fullness`` (h, w, 2) how far it usually stands off, of the mean ease.
    """

    mask: Mask
    cloth: GreyImage
    fullness: FullnessMap

    def beyond(
        self, rendering: Rendering, centres: Points2D, normals: Points2D
    ) -> Float[np.ndarray, " k"]:
        """Pixels from a contour outward to the outline, negative where it lies inside.

        Not finite where there is none in reach, or where another limb comes first: clothes then
        bridge a gap, and say nothing about the limbs on either side.
        """
        pixels_per_metre = rendering.camera.focal_length_px / float(rendering.vertices[:, 2].mean())
        inward, outward = round(INWARD_M * pixels_per_metre), round(FARTHEST_M * pixels_per_metre)
        steps = np.arange(-inward, outward + 1)
        places = centres[:, None] + steps[None, :, None] * normals[:, None]
        on_person, on_body = (_at(region, places) for region in (self.mask, rendering.silhouette))
        ahead = steps > _PAST_THE_RIM_PX
        # Outward from the contour while it shows the person, inward while it does not.
        outside = ~on_person
        leaves = np.where(outside & (steps >= 0), steps, outward + 1).min(axis=1)
        meets = np.where(on_body & ahead, steps, outward + 1).min(axis=1)
        enters = np.where(on_person & (steps < 0), steps, -inward - 1).max(axis=1)
        inside = on_person[:, inward]
        found = np.where(inside, leaves - 0.5, enters + 0.5)
        lost = np.where(inside, (leaves > outward) | (meets < leaves), enters < -inward)
        return np.where(lost, np.nan, found)

    def fullness_within(
        self, boundary: Points2D, normals: Points2D, pixels_per_metre: float
    ) -> Float[np.ndarray, "k 2"]:
        """Usual distance of cloth from the body at points of the boundary."""
        inside = boundary - WITHIN_M * pixels_per_metre * normals
        return np.stack([sample(self.fullness[..., k], inside)[0] for k in range(2)], axis=1)

    def cloth_within(
        self, boundary: Points2D, normals: Points2D, pixels_per_metre: float
    ) -> Float[np.ndarray, " k"]:
        """Probability that points of the boundary, with outward normals, belong to loose cloth."""
        return sample(self.cloth, boundary - WITHIN_M * pixels_per_metre * normals)[0]


_PAST_THE_RIM_PX = 2


def _at(region: Mask, places: Float[np.ndarray, "k s 2"]) -> np.ndarray:
    """The region at continuous pixels; False outside the picture."""
    height, width = region.shape
    column, row = (np.floor(places[..., axis]).astype(int) for axis in (0, 1))
    within = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    return region[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)] & within
