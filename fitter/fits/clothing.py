"""Loose clothes: where the outline only bounds the body from outside, and what else they hide."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage
from fitter.body.skeleton import regress
from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import seen_vertices
from fitter.evidence.intensity import IntensityMap
from fitter.evidence.loose_outline import LooseClothes
from fitter.evidence.sampling import sample
from fitter.evidence.silhouette_evidence import FullnessMap, uniform_fullness
from fitter.fits.prepared_model import PreparedModel
from fitter.fits.usual_ease import usual_fullness
from fitter.observation.observation import Observation
from fitter.parameters import BodyParameters
from fitter.remarks import Assumption, FitWarning
from fitter.render.rasterizer import Rendering, render
from fitter.segmentation.coverage import Coverage, coverage
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

FACE_CLICKS = ("nose", "left_eye", "right_eye")

LEAST_COVERED = 0.5
"""From what probability on that trunk or legs are covered, the outline is not the body's. Of 89
pictures of people in underwear 0.38 is the most, of 18 in clothes 0.97 the least."""

LOOSE_ABOVE_CLOSE, LOOSE_ABOVE_LOOSE = 0.5, 0.95
"""How often what covers the upper body is loose where what covers the legs is close or loose."""

LIKELY_LOOSE = 0.15
"""From what probability on clothes do not bind at all: even a small share of a tight outline would
outweigh all that is said of loose clothes."""

CLOSE_FULLNESS = 0.15
"""Ease of close clothes, as a share of that of loose ones."""

_OF_LEGS = frozenset({"thigh", "shin", "foot"})
_LEAST_PIXELS_PER_METRE = 120.0
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
    undressed = replace(objective, evidence=replace(objective.evidence, clothes=None))
    if observation.clothing is Clothing.TIGHT:
        return undressed
    vertices = prepared.searched.evaluator.vertices(near)
    rendering = render(vertices, prepared.searched.model.triangles, observation.camera)
    silhouette = objective.evidence.silhouette
    regions = PersonRegions(
        person=silhouette.mask,
        parts=_parts(rendering, prepared),
        part_names=prepared.searched.model.part_names,
        face=face_point(_clicked_face(observation), _nose(rendering, prepared)),
        pixels_per_metre=observation.camera.focal_length_px / float(near.translation[2]),
    )
    covered: Coverage | None = None
    if observation.clothing is Clothing.AUTO:
        covered = _coverage(observation, regions, prepared)
        if covered.anything < LEAST_COVERED:
            return undressed
    skin = skin_map(observation.linear_rgb, regions)
    bare, fullness = skin.probability, _fullness(rendering, prepared)
    if covered is not None:
        bare = covered.bare(skin, regions)
        legs = legs_are_loose(
            regions.person,
            bare,
            _joints_seen(rendering, prepared),
            regions.pixels_per_metre,
        )
        loose = _loose(regions, legs)
        bare = 1.0 - (1.0 - bare) * np.minimum(loose / LIKELY_LOOSE, 1.0)
        fullness = fullness * (CLOSE_FULLNESS + (1.0 - CLOSE_FULLNESS) * loose)[..., None]
    cloth = (1.0 - bare).astype(np.float32)
    return replace(
        objective,
        evidence=replace(
            objective.evidence,
            silhouette=replace(silhouette, cloth=cloth, fullness=fullness),
            clothes=LooseClothes(
                bare=sample(bare, rendering.projected)[0],
                learnt_from=skin.learnt_from,
                looks_undressed=looks_undressed(skin, regions),
            ),
        ),
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


def clothing_remarks(
    objective: Objective,
) -> tuple[tuple[Assumption, ...], tuple[FitWarning, ...]]:
    """How the outline was interpreted, and what makes that doubtful; empty for tight clothes."""
    evidence = objective.evidence
    if evidence.clothes is None:
        return (), ()
    along = evidence.silhouette.cloth_at(evidence.silhouette.boundary_points)
    share = float(along.mean()) if len(along) else 0.0
    metres = objective.scales.ease_mean / objective.scales.pixels_per_metre
    assumption = Assumption(
        quantity="outline",
        value="outer bound",
        reason=(
            f"Clothing is loose: where clothes show, along {share:.0%} of the outline, the body is "
            f"taken to lie within it, by {100.0 * metres:.0f} cm or so; along bare skin, on it."
        ),
    )
    if not evidence.clothes.learnt_from:
        return (assumption,), (_NO_SKIN,)
    return (assumption,), (_NOT_LOOSE,) if evidence.clothes.looks_undressed else ()


_NO_SKIN = FitWarning(
    code="skin-not-found",
    message=(
        "Neither face nor hands show the colour of the person's skin, or the picture has no "
        "colours: which parts are bare is guessed. Click the nose or the eyes if they are seen; "
        "send the picture in colour if there is one."
    ),
)

_NOT_LOOSE = FitWarning(
    code="clothes-not-loose",
    message=(
        "Trunk and thighs show much of the colour of the person's skin, as in underwear or "
        "swimwear. If nothing loose hides them, say that clothing is tight: as it is, girths may "
        "come out several centimetres too small."
    ),
)


def _parts(rendering: Rendering, prepared: PreparedModel) -> np.ndarray:
    """(h, w) index of the part each pixel shows, -1 off the body."""
    faces = rendering.face_ids
    return np.where(faces >= 0, prepared.searched.model.part_of_triangle[faces], -1)


def _coverage(
    observation: Observation, regions: PersonRegions, prepared: PreparedModel
) -> Coverage:
    """What is covered, from every second or third pixel where there are enough."""
    step = max(int(regions.pixels_per_metre / _LEAST_PIXELS_PER_METRE), 1)
    fewer = replace(
        regions,
        person=np.ascontiguousarray(regions.person[::step, ::step]),
        parts=np.ascontiguousarray(regions.parts[::step, ::step]),
        face=None if regions.face is None else regions.face / step,
        pixels_per_metre=regions.pixels_per_metre / step,
    )
    skin = skin_map(np.ascontiguousarray(observation.linear_rgb[::step, ::step]), fewer)
    return coverage(skin, fewer, prepared.searched.model.gender)


def _joints_seen(
    rendering: Rendering, prepared: PreparedModel
) -> dict[str, Float[np.ndarray, "2"]]:
    model = prepared.searched.model
    joints = regress(model.joint_regressor, rendering.vertices)
    return dict(zip(model.part_names, rendering.camera.project(joints), strict=True))


def _loose(regions: PersonRegions, legs: float) -> GreyImage:
    """(h, w) probability that what covers a pixel's part is loose, given that of the legs'."""
    upper = LOOSE_ABOVE_CLOSE + (LOOSE_ABOVE_LOOSE - LOOSE_ABOVE_CLOSE) * legs
    of_part = [
        legs if name.rpartition("_")[2] in _OF_LEGS else upper for name in regions.part_names
    ]
    return np.array(of_part, dtype=np.float32)[nearest_part(regions)]


def _fullness(rendering: Rendering, prepared: PreparedModel) -> FullnessMap:
    """The usual ease of the body each pixel shows or is nearest to."""
    model = prepared.searched.model
    of_triangle = usual_fullness(model)[model.triangles].mean(axis=1).astype(np.float32)
    faces = rendering.face_ids
    if not (faces >= 0).any():
        return uniform_fullness(faces.shape)
    return of_triangle[faces.ravel()[nearest_of(faces >= 0)]]


def _clicked_face(observation: Observation) -> np.ndarray:
    clicks = [observation.clicks.get(name) for name in FACE_CLICKS]
    return np.array(
        [(click.x, click.y) for click in clicks if click is not None and not click.occluded]
    ).reshape(-1, 2)


def _nose(rendering: Rendering, prepared: PreparedModel) -> np.ndarray | None:
    """Where the nose of a rendered body is seen; None where it is hidden."""
    landmarks = prepared.searched.model.landmarks
    point = regress(landmarks, rendering.vertices)[landmarks.names.index("nose")]
    place = rendering.camera.project(point[None])[0]
    column, row = int(place[0]), int(place[1])
    if not (0 <= row < rendering.camera.height and 0 <= column < rendering.camera.width):
        return None
    hidden = float(point[2]) - float(rendering.depth[row, column]) > _SEEN_WITHIN_M
    return None if hidden else place
