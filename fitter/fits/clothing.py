"""Loose clothes: where the outline only bounds the body from outside, and what else they hide.

Read off clothes draped over ten bodies by another program, which hang as cloth does: shirts,
blouses, hoodies and a jacket, trousers and shorts. Metres, the median over people; leggings and
skirts left out. Shirts are 4 mm wider, halfway to those of the evaluation's own clothed people,
whose measurements came out too large. How wide the clothes of one person are, and of which garment,
is for the fit to find (:mod:`fitter.energies.silhouette`).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.special import expit

from fitter.arrays import GreyImage, Image
from fitter.body.model import BodyModel, regress
from fitter.energies.objective import Candidate, Objective
from fitter.energies.scales import EASE_MEAN_M
from fitter.energies.shading import IntensityMap, seen_vertices
from fitter.evidence.loose_outline import LooseClothes
from fitter.evidence.silhouette_evidence import FullnessMap, uniform_fullness
from fitter.fits.clothing_report import worn_regions
from fitter.fits.equipment import PreparedModel
from fitter.observation.maps import sample
from fitter.observation.observation import Observation
from fitter.parameters import BodyParameters
from fitter.render.rasterizer import Rendering, render
from fitter.request import SaidClothing
from fitter.segmentation.coverage import Coverage, bare_forearms, coverage
from fitter.segmentation.leg_looseness import legs_are_loose
from fitter.segmentation.skin_colour import (
    LEAST_SAMPLES,
    PersonRegions,
    SkinMap,
    face_point,
    nearest_of,
    nearest_part,
    skin_map,
)
from fitter.vocabulary.choices import Clothing
from fitter.vocabulary.outcomes import WornRegion


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

SHORT_TOP, LONG_TOP, ANY_TOP, OUTER = 0.72, 2.0, 3.0, 3.7
"""The same of what hangs off the trunk: tops, long sleeves that may be those of jackets, jackets.

Of 32 real people seen from the front, what is worn over a top makes them 11 cm broader at 0.58 of
their height, 5.4 cm a side beside the 2 of the top: 2.9 times the usual. The population is heavier
than these people; with 3.7 waists in jackets are 0.6 cm less too large. Where no detector tells,
two of three long sleeves in the street are taken to be those of a jacket or a coat."""

OUTER_SLEEVES = 0.8
"""The same of sleeves of what is worn over a top. Sleeves and trunk share an offset: with 2.2 those
of 16 real jackets, which hang no wider than a hoodie's, make waists 2 cm larger."""

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


def worn_over(seen: GreyImage | None, regions: PersonRegions) -> GreyImage | None:
    """Probability (h, w) that what a pixel shows is worn over a top; off the person, the nearest's.

    ``seen`` (h, w) is what a network says of each pixel by itself. None where it says nothing, or
    no trunk is in sight.
    """
    numbers = [n for n, name in enumerate(regions.part_names) if name in _OF_TRUNK]
    trunk = regions.person & np.isin(regions.parts, numbers)
    if seen is None or np.count_nonzero(trunk) < LEAST_SAMPLES:
        return None
    is_worn = expit((float(seen[trunk].mean()) - WORN_OVER) / WORN_OVER_SPREAD)
    shows = expit((seen - SHOWS_OVER) / SHOWS_OVER_SPREAD)
    return (is_worn * shows).astype(np.float32).ravel()[nearest_of(regions.person)]


def _side_and_kind(part: str) -> tuple[str, str]:
    for side in ("left_", "right_"):
        if part.startswith(side):
            return side, part.removeprefix(side)
    return "", part


FACE_CLICKS = ("nose", "left_eye", "right_eye")

LEAST_COVERED = 0.5
"""From what probability on that trunk or legs are covered, the outline is not the body's. Of 96
pictures of people in underwear, one has 0.66 and none of the others more than 0.17; of 58 in
clothes, all but four painted on people who are seen from the side have 0.54 or more."""

LOOSE_ABOVE_CLOSE, LOOSE_ABOVE_LOOSE = 0.65, 0.95
"""Probabilities of loose clothes on the upper body, above close and above loose ones on the legs.

Above leggings and slim jeans loose tops are usual; close ones bind by how far they are taken to
stand off, and by nothing else."""

CLOSE_FULLNESS = 0.15
"""Ease of close clothes, as a share of that of loose ones."""

_OF_LEGS = frozenset({"thigh", "shin", "foot"})
_OF_TRUNK = ("chest", "spine", "pelvis")
_SAID = {Clothing.TIGHT: 0.0, Clothing.LOOSE: 1.0}
LEAST_PIXELS_PER_METRE = 120.0
_SEEN_WITHIN_M = 0.02
_BARE = 0.5

_UNDRESSED = (("pelvis", "spine", "chest"), ("left_thigh", "right_thigh"))
_UNDRESSED_SHARE = 0.25
# Share of each group of parts. On the tuning half, people in underwear show at least 0.54 of the
# trunk and 0.35 of the thighs in their skin's colour; those in loose clothes at most 0.08 and 0.12.


def dressed(
    objective: Objective, observation: Observation, prepared: PreparedModel, near: BodyParameters
) -> Objective:
    """The objective of a person dressed as the caller or the picture says, given a body near them.

    For tight clothes, and people in underwear, the objective is that of the body's outline.
    """
    said = observation.clothing
    if said.both == {Clothing.TIGHT}:
        return replace(objective, evidence=replace(objective.evidence, clothes=None, worn=()))
    vertices = prepared.searched.evaluator.vertices(near)
    rendering = render(vertices, prepared.searched.model.triangles, observation.camera)
    silhouette = objective.evidence.silhouette
    regions = PersonRegions(
        person=silhouette.mask,
        parts=_parts(rendering, prepared),
        part_names=prepared.searched.model.part_names,
        face=_face(observation, rendering, prepared),
        pixels_per_metre=observation.camera.focal_length_px / float(near.translation[2]),
    )
    skin = _skin(observation.linear_rgb, regions)
    covered = _coverage(skin, regions, said, gender=prepared.searched.model.gender)
    if Clothing.LOOSE not in said.both and covered.anything < LEAST_COVERED:
        worn = worn_regions(regions, skin, covered, bare=None, loose=None)
        return replace(objective, evidence=replace(objective.evidence, clothes=None, worn=worn))
    bare = skin.probability if said.both == {Clothing.LOOSE} else covered.bare(skin, regions)
    loose = _loose(said, regions, bare, _joints_seen(rendering, prepared), skin)
    cloth = (1.0 - bare).astype(np.float32)
    over = worn_over(observation.outer_cloth, regions)
    fullness = CLOSE_FULLNESS + (1.0 - CLOSE_FULLNESS) * loose
    return replace(
        objective,
        evidence=replace(
            objective.evidence,
            silhouette=replace(
                silhouette,
                cloth=cloth,
                fullness=_fullness(rendering, prepared, shares_by_sleeves(regions, bare), over)
                * fullness[..., None],
            ),
            clothes=LooseClothes(
                bare=1.0 - sample(cloth, rendering.projected)[0],
                learnt_from=skin.learnt_from,
                looks_undressed=looks_undressed(skin, regions),
                over_top=None if over is None else bool(over.max() > _BARE),
            ),
            worn=worn_regions(regions, skin, covered, bare=bare, loose=loose),
        ),
    )


def clothing_seen(
    linear_rgb: Image,
    regions: PersonRegions,
    joints: Mapping[str, Float[np.ndarray, "2"]],
    *,
    gender: str | None,
) -> tuple[WornRegion, ...] | None:
    """Covering of each region in sight, before a body is fitted.

    None where it cannot be told, for nothing shows the colour of the person's skin.

    Parameters
    ----------
    linear_rgb
        (h, w, 3) linear light.
    joints
        Where the parts begin, by their names, continuous pixels.
    """
    said = SaidClothing(upper=Clothing.AUTO, lower=Clothing.AUTO)
    skin = _skin(linear_rgb, regions)
    if not skin.learnt_from:
        return None
    covered = _coverage(skin, regions, said, gender=gender)
    if covered.anything < LEAST_COVERED:
        return worn_regions(regions, skin, covered, bare=None, loose=None)
    bare = covered.bare(skin, regions)
    return worn_regions(
        regions, skin, covered, bare=bare, loose=_loose(said, regions, bare, joints, skin)
    )


def where_bare(
    objective: Objective, candidate: Candidate, intensity: IntensityMap
) -> tuple[Objective, IntensityMap]:
    """Restrict shading to bare skin: folds of loose cloth are not the body.

    Shading is trusted in proportion to the skin seen: its full weight is for a whole visible body.
    """
    cloth = objective.evidence.silhouette.cloth
    if cloth is None:
        return objective, intensity
    areas = objective.operators.shaded.areas
    seen = seen_vertices(candidate.rendering, intensity)
    bare = replace(intensity, trusted=intensity.trusted & (cloth < _BARE))
    seen_bare = seen_vertices(candidate.rendering, bare)
    share = float(areas[seen_bare].sum()) / max(float(areas[seen].sum()), 1e-12)
    scales = replace(objective.scales, shading_weight=share * objective.scales.shading_weight)
    return replace(objective, scales=scales), bare


def looks_undressed(skin: SkinMap, regions: PersonRegions) -> bool:
    """Whether trunk and thighs both show much of the skin's colour, as in underwear.

    False where either is out of sight: a bare chest above wide trousers is no mistake.
    """
    for group in _UNDRESSED:
        numbers = [regions.part_names.index(name) for name in group]
        seen = regions.person & np.isin(regions.parts, numbers)
        if np.count_nonzero(seen) < LEAST_SAMPLES:
            return False
        if np.mean(skin.coloured[seen]) < _UNDRESSED_SHARE:
            return False
    return True


def _parts(rendering: Rendering, prepared: PreparedModel) -> np.ndarray:
    """(h, w) index of the part each pixel shows, -1 off the body."""
    faces = rendering.face_ids
    return np.where(faces >= 0, prepared.searched.model.part_of_triangle[faces], -1)


def _skin(linear_rgb: Image, regions: PersonRegions) -> SkinMap:
    """Map of skin, from every second or third pixel where there are enough."""
    step = max(int(regions.pixels_per_metre / LEAST_PIXELS_PER_METRE), 1)
    middle = slice(step // 2, None, step)
    fewer = replace(
        regions,
        person=np.ascontiguousarray(regions.person[middle, middle]),
        parts=np.ascontiguousarray(regions.parts[middle, middle]),
        face=None if regions.face is None else regions.face / step,
        pixels_per_metre=regions.pixels_per_metre / step,
    )
    found = skin_map(np.ascontiguousarray(linear_rgb[middle, middle]), fewer)
    nearest = np.ix_(
        *(
            np.minimum(np.arange(size) // step, fewer_size - 1)
            for size, fewer_size in zip(regions.person.shape, fewer.person.shape, strict=True)
        )
    )
    return replace(
        found,
        probability=found.probability[nearest],
        coloured=found.coloured[nearest] & regions.person,
    )


def _coverage(
    skin: SkinMap, regions: PersonRegions, said: SaidClothing, *, gender: str | None
) -> Coverage:
    """Coverage as the caller says, else as the picture shows."""
    found = coverage(skin, regions, gender)
    if said.upper is Clothing.LOOSE:
        found = replace(found, top=1.0)
    return replace(found, bottom=1.0) if said.lower is Clothing.LOOSE else found


def _joints_seen(
    rendering: Rendering, prepared: PreparedModel
) -> dict[str, Float[np.ndarray, "2"]]:
    model = prepared.searched.model
    joints = regress(model.joint_regressor, rendering.vertices)
    return dict(zip(model.part_names, rendering.camera.project(joints), strict=True))


def _loose(
    said: SaidClothing,
    regions: PersonRegions,
    bare: GreyImage,
    joints: Mapping[str, Float[np.ndarray, "2"]],
    skin: SkinMap,
) -> GreyImage:
    """(h, w) probability that what covers a pixel's part is loose.

    Close legs foretell a close top, but where nothing shows the skin's colour they may be bare.
    """
    lower = _SAID.get(said.lower)
    if lower is None:
        lower = legs_are_loose(regions.person, bare, joints, regions.pixels_per_metre)
    upper = _SAID.get(said.upper)
    if upper is None:
        like_legs = lower if skin.learnt_from else 1.0
        upper = LOOSE_ABOVE_CLOSE + (LOOSE_ABOVE_LOOSE - LOOSE_ABOVE_CLOSE) * like_legs
    by_kind = {"pelvis": max(upper, lower)} | dict.fromkeys(_OF_LEGS, lower)
    of_part = [by_kind.get(name.rpartition("_")[2], upper) for name in regions.part_names]
    return np.array(of_part, dtype=np.float32)[nearest_part(regions)]


def _fullness(
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
    trunk, arms = shares.any_trunk, shares.arms
    if over is not None:
        trunk = shares.trunk + over * (OUTER - shares.trunk)
        arms = shares.arms + over * (OUTER_SLEEVES - shares.arms)
    fullness = of_triangle[nearest]
    fullness[..., 0] *= np.where(on_trunk[nearest], trunk, arms)
    return fullness


def _face(
    observation: Observation, rendering: Rendering, prepared: PreparedModel
) -> np.ndarray | None:
    """Place of the face; None where it is not seen."""
    if observation.hides_face:
        return None
    return face_point(_clicked_face(observation), _nose(rendering, prepared))


def _clicked_face(observation: Observation) -> np.ndarray:
    clicks = [observation.clicks.get(name) for name in FACE_CLICKS]
    return np.array(
        [(click.x, click.y) for click in clicks if click is not None and not click.occluded]
    ).reshape(-1, 2)


def _nose(rendering: Rendering, prepared: PreparedModel) -> np.ndarray | None:
    """Place of the nose of a rendered body; None where it is hidden."""
    landmarks = prepared.searched.model.landmarks
    point = regress(landmarks, rendering.vertices)[landmarks.names.index("nose")]
    place = rendering.camera.project(point[None])[0]
    column, row = int(place[0]), int(place[1])
    if not (0 <= row < rendering.camera.height and 0 <= column < rendering.camera.width):
        return None
    hidden = float(point[2]) - float(rendering.depth[row, column]) > _SEEN_WITHIN_M
    return None if hidden else place
