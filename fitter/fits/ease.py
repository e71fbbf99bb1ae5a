"""Ease: how far loose clothes usually stand off, by place and by what is worn.

Read off clothes draped over ten bodies by another program, which hang as cloth does: shirts,
blouses, hoodies and a jacket, trousers and shorts. Metres, the median over people; leggings and
skirts left out. Shirts are 4 mm wider, halfway to those of the evaluation's own clothed people,
whose measurements came out too large. How wide the clothes of one person are, and of which garment,
is for the fit to find (:mod:`fitter.energies.silhouette`).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.special import expit

from fitter.arrays import GreyImage
from fitter.body.model import BodyModel, regress
from fitter.detection.worn_parts import WornShares
from fitter.energies.scales import EASE_MEAN_M
from fitter.evidence.silhouette_evidence import FullnessMap, uniform_fullness
from fitter.fits.equipment import PreparedModel
from fitter.render.rasterizer import Rendering
from fitter.segmentation.coverage import bare_forearms
from fitter.segmentation.skin_colour import LEAST_SAMPLES, PersonRegions, nearest_of

_OF_TRUNK = ("chest", "spine", "pelvis")


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
"""Ease of sleeves of tops that leave forearms bare, and of those that cover them, as a share of the
usual: a T-shirt is cut closer than a hoodie. Of ten draped outfits, 0.66 and 1.43 of the mean at
the chest, 0.72 and 1.35 at the waist."""

SHORT_TOP, LONG_TOP, ANY_TOP, OUTER = 0.72, 2.0, 3.0, 5.0
"""The same of what hangs off the trunk: tops, long sleeves that may be those of jackets, jackets.

Of 32 real people seen from the front, what is worn over a top makes them 11 cm broader at 0.58 of
their height, 5.4 cm a side beside the 2 of the top: 2.9 times the usual. But the population is
heavier than these people, and where a jacket is widest no outline is found: with 3.0, waists in
jackets are 5.9 cm larger than without, with 5.0 2.7 and with 6.0 2.5, but differ more. Where no
detector tells, two of three long sleeves in the street are taken to be those of a jacket."""

WORN_OVER, WORN_OVER_SPREAD = 0.36, 0.04
"""Mean probability of outer cloth on the trunk at which something is as probably worn over a top as
not, and how fast that turns: 16 real people who wear it have 0.35 to 0.7, without it 0 to 0.35."""

SHOWS_OVER, SHOWS_OVER_SPREAD = 0.3, 0.06
"""The same of a pixel of who wears it. At its rim 16 real people's has 0.46 to 0.88, what shows
beside it 0.03 to 0.06."""


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


@dataclass(frozen=True, slots=True, kw_only=True)
class TopShares:
    """The ease of a top as a share of the usual, and of what is worn over it.

    ``trunk`` is that of the top alone, ``any_trunk`` where it is not known whether something is
    worn over it, ``arms`` that of sleeves.
    """

    trunk: float = 1.0
    any_trunk: float = 1.0
    arms: float = 1.0


def shares_by_sleeves(regions: PersonRegions, bare: GreyImage) -> TopShares:
    """Shares by whether a top covers forearms; 1 where no forearm is in sight.

    ``bare`` (h, w) is the probability that a pixel's part is bare.
    """
    numbers = [n for n, name in enumerate(regions.part_names) if name.endswith("_forearm")]
    seen = regions.person & np.isin(regions.parts, numbers)
    if np.count_nonzero(seen) < LEAST_SAMPLES:
        return TopShares()
    short = bare_forearms(float(bare[seen].mean()))
    trunk, any_trunk, arms = (
        short * shorter + (1.0 - short) * longer
        for shorter, longer in (
            (SHORT_TOP, LONG_TOP),
            (SHORT_TOP, ANY_TOP),
            (SHORT_SLEEVED, LONG_SLEEVED),
        )
    )
    return TopShares(trunk=trunk, any_trunk=any_trunk, arms=arms)


def worn_over(worn: WornShares | None, regions: PersonRegions) -> GreyImage | None:
    """Probability (h, w) that what a pixel shows is worn over a top; off the person, the nearest's.

    None where no network says what a pixel shows by itself, or no trunk is in sight.
    """
    numbers = [n for n, name in enumerate(regions.part_names) if name in _OF_TRUNK]
    trunk = regions.person & np.isin(regions.parts, numbers)
    if worn is None or np.count_nonzero(trunk) < LEAST_SAMPLES:
        return None
    is_worn = expit((float(worn.outer[trunk].mean()) - WORN_OVER) / WORN_OVER_SPREAD)
    shows = expit((worn.outer - SHOWS_OVER) / SHOWS_OVER_SPREAD)
    return (is_worn * shows).astype(np.float32).ravel()[nearest_of(regions.person)]


def ease_map(
    rendering: Rendering, prepared: PreparedModel, shares: TopShares, over: GreyImage | None
) -> FullnessMap:
    """The usual ease of the body each pixel shows or is nearest to, times a top's shares."""
    model = prepared.searched.model
    faces = rendering.face_ids
    if not (faces >= 0).any():
        return uniform_fullness(faces.shape)
    of_triangle = usual_fullness(model)[model.triangles].mean(axis=1).astype(np.float32)
    on_trunk = np.isin(np.array(model.part_names)[model.part_of_triangle], _OF_TRUNK)
    nearest = faces.ravel()[nearest_of(faces >= 0)]
    trunk = shares.any_trunk
    if over is not None:
        trunk = shares.trunk + over * (OUTER - shares.trunk)
    fullness = of_triangle[nearest]
    fullness[..., 0] *= np.where(on_trunk[nearest], trunk, shares.arms)
    return fullness


def _side_and_kind(part: str) -> tuple[str, str]:
    for side in ("left_", "right_"):
        if part.startswith(side):
            return side, part.removeprefix(side)
    return "", part
