"""The person cut out around a body, and E1 of pictures, given a body near the person."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fitter.arrays import GreyImage, Shape
from fitter.body.model import regress
from fitter.energies.edges import edge_cost_map
from fitter.energies.landmarks import SlantEvidence, click_evidence
from fitter.energies.objective import JointObjective, Objective
from fitter.energies.scales import scales_at
from fitter.energies.shape_terms import POPULATION_PRECISION, population_prior
from fitter.energies.terms import PictureEvidence
from fitter.evidence.doubtful_outline import outline_confidence
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.fits.clothing import dressed
from fitter.fits.equipment import PreparedModel
from fitter.observation.observation import Observation
from fitter.parameters import BodyParameters
from fitter.person.several_pictures import counted_as
from fitter.population.known_person import KnownPerson
from fitter.pose_init.landmark_rig import landmark_rig
from fitter.pose_init.limbs import limb_reaches
from fitter.render.rasterizer import render
from fitter.segmentation.bones import clicked_bones, foot_bones
from fitter.segmentation.grabcut import Segmentation, border_warnings, preference, segment
from fitter.segmentation.trimap import (
    Trimap,
    first_band,
    seeded_person,
    seeded_trimap,
    trimap,
)

RESEGMENTED_BAND = 0.5
"""Width of the second band as a share of the first. The picture is segmented again around the body
found from the first cut (section 7 names this as future work), so that what the first cut mistook
for the person far from any body, such as ground of the skin's colour, is now out of reach."""

DOUBTFUL_PARTS = ("head", "left_hand", "right_hand")
"""Parts whose outline says little of the body: hair, and hands in a pose of their own."""

_DOUBTFUL_MARGIN_M = 0.05

_EDGE_THRESHOLD_M = 0.03
"""Largest distance at which an image edge still attracts a model edge."""

UNDER_CLOTHES_PRECISION = 1.0
"""Precision of the population's prior where every outline is that of clothes: as it was learned."""

SHARED_ERROR = 0.2
"""Correlation of the errors of two pictures that are searched together. It is less than that of
whole fits of one picture (:data:`fitter.person.several_pictures.SHARED_ERROR`), because what a
prior about depth makes them err in alike, another view tells."""


def segmented(
    observation: Observation,
    prepared: PreparedModel,
    parameters: BodyParameters,
    *,
    fitted: bool,
    loosely_dressed: bool = False,
) -> tuple[Trimap | None, Segmentation]:
    """The caller's mask, or GrabCut (section 3.2).

    Its tri-map lies around the detector's mask if there is one, else around a body. ``fitted`` says
    that the body was fitted to the picture, and is no first guess: for a first guess the detector's
    mask is near enough as it is.
    """
    if observation.mask is not None:
        return None, Segmentation(mask=observation.mask, warnings=border_warnings(observation.mask))
    vertices = prepared.searched.evaluator.vertices(parameters)
    landmarks = prepared.searched.model.landmarks
    points = observation.camera.project(regress(landmarks, vertices))
    seen = dict(zip(landmarks.names, points, strict=True))
    bones = np.concatenate(
        [clicked_bones(observation.clicks), foot_bones(observation.clicks, seen)]
    )
    seed = observation.seed
    if seed is not None and not fitted:
        uncut = seeded_person(seed, bones)
        if uncut is not None:
            return None, Segmentation(mask=uncut, warnings=border_warnings(uncut))
    silhouette = render(vertices, prepared.searched.model.triangles, observation.camera).silhouette
    # The body inside loose clothes does not say how far they reach.
    telling = fitted and not loosely_dressed
    if seed is not None and (labels := seeded_trimap(seed, bones)) is not None:
        preferred = preference(seed, silhouette if telling else None)
        return labels, segment(observation.display, labels, preferred)
    share = RESEGMENTED_BAND if telling else 1.0
    labels = trimap(silhouette, bones, band=share * first_band(silhouette, bones))
    return labels, segment(observation.display, labels)


def silhouette_and_edges(
    observation: Observation,
    prepared: PreparedModel,
    near: BodyParameters,
    segmentation: Segmentation,
    *,
    boundary_eta_m: float,
) -> Objective:
    """E1 of a picture, with the scales at a body near the person.

    ``boundary_eta_m`` is how far away a boundary may be and still attract the body; see
    :mod:`fitter.energies.scales`.
    """
    depth = float(near.translation[2])
    pixels_per_metre = observation.camera.focal_length_px / depth
    confidence = _outline_confidence(observation, prepared, near, pixels_per_metre)
    objective = Objective(
        operators=prepared.searched,
        evidence=PictureEvidence(
            camera=observation.camera,
            clicks=click_evidence(prepared.searched.model.landmarks, observation.clicks),
            slants=limb_slants(observation, prepared, near.shape),
            silhouette=silhouette_evidence(segmentation.mask, confidence),
            edges=edge_cost_map(
                observation.display, threshold_px=_EDGE_THRESHOLD_M * pixels_per_metre
            ),
            shading=None,
        ),
        scales=scales_at(observation.camera, depth, boundary_eta_m=boundary_eta_m),
        posture=observation.posture,
    )
    return dressed(objective, observation, prepared, near)


def of_person(known: KnownPerson, pictures: Sequence[Objective]) -> JointObjective:
    """The energy of a person in one or several pictures: what is known of them counts once."""
    return JointObjective(
        views=tuple(pictures),
        weight=counted_as(len(pictures), shared=SHARED_ERROR) / len(pictures),
        shape_prior=population_prior(len(known.shape), prior_precision(pictures)),
        attributes=known.attributes,
    )


def prior_precision(pictures: Sequence[Objective]) -> float:
    """Precision of the population's prior, by whether any picture shows the body's outline."""
    is_clothed = all(each.evidence.clothes is not None for each in pictures)
    return UNDER_CLOTHES_PRECISION if is_clothed else POPULATION_PRECISION


def with_silhouette(
    objective: Objective,
    segmentation: Segmentation,
    observation: Observation,
    prepared: PreparedModel,
    near: BodyParameters,
) -> Objective:
    """The same objective with the person segmented again around a body.

    A person who was found undressed before is not looked at again.
    """
    evidence = objective.evidence
    silhouette = silhouette_evidence(segmentation.mask, evidence.silhouette.confidence)
    cut = replace(objective, evidence=replace(evidence, silhouette=silhouette))
    if evidence.clothes is None:
        return cut
    return dressed(cut, observation, prepared, near)


def _outline_confidence(
    observation: Observation,
    prepared: PreparedModel,
    near: BodyParameters,
    pixels_per_metre: float,
) -> GreyImage:
    """A map of weights, low where a body near the person has its head and hands."""
    model = prepared.searched.model
    projected = observation.camera.project(prepared.searched.evaluator.vertices(near))
    corners = [
        model.triangles[model.part_of_triangle == model.part_names.index(part)]
        for part in DOUBTFUL_PARTS
    ]
    return outline_confidence(
        observation.camera.height,
        observation.camera.width,
        [projected[np.unique(triangles)] for triangles in corners],
        margin_px=_DOUBTFUL_MARGIN_M * pixels_per_metre,
    )


def limb_slants(
    observation: Observation, prepared: PreparedModel, shape: Shape
) -> SlantEvidence | None:
    """Slants of the limbs whose two ends are among the clicks; None if there are none.

    ``shape`` (n,) gives the limbs' lengths.
    """
    if observation.slants is None:
        return None
    names = list(observation.clicks)
    rig = landmark_rig(prepared.searched.model, shape)
    reaches = limb_reaches(observation.slants, rig, observation.camera, points=names)
    if not reaches.limbs:
        return None
    return SlantEvidence(
        ends=np.array(
            [[names.index(limb.proximal), names.index(limb.distal)] for limb in reaches.limbs]
        ),
        toward=reaches.toward,
        reach_m=reaches.reach_m,
        sigma_m=reaches.sigma_m,
    )
