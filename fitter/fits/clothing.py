"""Loose clothes: where the outline only bounds the body from outside, and what else they hide.

How far they stand off is for :mod:`fitter.fits.ease`.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage, Image
from fitter.body.model import regress
from fitter.detection.worn_parts import WornShares
from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import IntensityMap, seen_vertices
from fitter.evidence.loose_outline import LooseClothes
from fitter.fits.clothing_report import SAID_LOOSE, worn_regions
from fitter.fits.ease import ease_map, shares_by_sleeves, worn_over
from fitter.fits.equipment import PreparedModel
from fitter.observation.maps import sample
from fitter.observation.observation import Observation
from fitter.parameters import BodyParameters
from fitter.render.rasterizer import Rendering, render
from fitter.request import SaidClothing
from fitter.segmentation.coverage import Coverage, coverage
from fitter.segmentation.leg_looseness import legs_are_loose
from fitter.segmentation.skin_colour import (
    PersonRegions,
    SkinMap,
    face_point,
    nearest_of,
    nearest_part,
    skin_map,
)
from fitter.vocabulary.choices import Clothing
from fitter.vocabulary.outcomes import WornRegion

FACE_CLICKS = ("nose", "left_eye", "right_eye")

LEAST_COVERED = 0.5
"""From what probability on that trunk or legs are covered, the outline is not the body's. Of 153
pictures of people in underwear two have more, 0.64 and 0.68; of 98 in clothes one has less."""

LOOSE_ABOVE_CLOSE, LOOSE_ABOVE_LOOSE = 0.65, 0.95
"""Probabilities of loose clothes on the upper body, above close and above loose ones on the legs.

Above leggings and slim jeans loose tops are usual; close ones bind by how far they are taken to
stand off, and by nothing else."""

CLOSE_FULLNESS = 0.15
"""Ease of close clothes, as a share of that of loose ones."""

_OF_LEGS = frozenset({"thigh", "shin", "foot"})
_SAID = {Clothing.TIGHT: 0.0, Clothing.LOOSE: 1.0, Clothing.OUTER: 1.0}
LEAST_PIXELS_PER_METRE = 120.0
_SEEN_WITHIN_M = 0.02
_BARE = 0.5


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
    skin = _skin(observation.linear_rgb, observation.worn, regions)
    seen = coverage(skin, regions, prepared.searched.model.gender)
    covered = _as_said(seen, said)
    if not SAID_LOOSE & said.both and covered.anything < LEAST_COVERED:
        worn = worn_regions(regions, skin, covered, bare=None, loose=None)
        return replace(objective, evidence=replace(objective.evidence, clothes=None, worn=worn))
    bare = skin.probability if said.both <= SAID_LOOSE else covered.bare(skin, regions)
    loose = _loose(said, regions, bare, _joints_seen(rendering, prepared), skin)
    cloth = (1.0 - bare).astype(np.float32)
    over = worn_over(observation.worn, regions) if skin.learnt_from else None
    if said.upper is Clothing.OUTER:
        over = np.ones_like(cloth)
    fullness = CLOSE_FULLNESS + (1.0 - CLOSE_FULLNESS) * loose
    return replace(
        objective,
        evidence=replace(
            objective.evidence,
            silhouette=replace(
                silhouette,
                cloth=cloth,
                fullness=ease_map(rendering, prepared, shares_by_sleeves(regions, bare), over)
                * fullness[..., None],
            ),
            clothes=LooseClothes(
                bare=1.0 - sample(cloth, rendering.projected)[0],
                learnt_from=skin.learnt_from,
                looks_undressed=seen.anything < LEAST_COVERED,
                over_top=None if over is None else bool(min(over.max(), covered.top) > _BARE),
            ),
            worn=worn_regions(regions, skin, covered, bare=bare, loose=loose),
        ),
    )


def clothing_seen(
    linear_rgb: Image,
    worn: WornShares | None,
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
    worn
        What a network sees there, if it was asked.
    joints
        Where the parts begin, by their names, continuous pixels.
    """
    said = SaidClothing(upper=Clothing.AUTO, lower=Clothing.AUTO)
    skin = _skin(linear_rgb, worn, regions)
    if not skin.learnt_from:
        return None
    covered = coverage(skin, regions, gender)
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


def _parts(rendering: Rendering, prepared: PreparedModel) -> np.ndarray:
    """(h, w) index of the part each pixel shows, -1 off the body."""
    faces = rendering.face_ids
    return np.where(faces >= 0, prepared.searched.model.part_of_triangle[faces], -1)


def _skin(linear_rgb: Image, worn: WornShares | None, regions: PersonRegions) -> SkinMap:
    """Map of skin: colours of every second or third pixel where there are enough, and a network's.

    Where nothing shows the skin's colour, as in a grey picture, the network is not believed.
    """
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
    found = replace(
        found,
        probability=found.probability[nearest],
        coloured=found.coloured[nearest] & regions.person,
    )
    if worn is None or not found.learnt_from:
        return found
    seen = worn.skin.ravel()[nearest_of(regions.person)]
    return replace(found, probability=seen, by_network=True)


def _as_said(found: Coverage, said: SaidClothing) -> Coverage:
    if said.upper in SAID_LOOSE:
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
