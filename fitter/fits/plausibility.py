"""Plausibility that it is a person whom a body was fitted to.

A body can be fitted to anything that points are put on. What tells a person from a landscape, a
circle, a dog or two people in one mask is how well the end of the search agrees with the evidence
(:mod:`fitter.fits.verdict` judges it).
"""

from dataclasses import dataclass

import cv2
import numpy as np

from fitter.arrays import Mask
from fitter.energies.correspondence_lines import LEAST_WINDOW_PX, WINDOW_M
from fitter.energies.objective import Candidate, Objective
from fitter.evidence.doubtful_outline import outgrown_m
from fitter.evidence.loose_outline import FARTHEST_M
from fitter.observation.observation import Observation
from fitter.optimizer.search import with_lines_about

BEYOND_M = 0.1
"""Distance from the body beyond which what is taken for the person is not theirs: hair, clothes and
errors of segmentation are nearer."""

CLEAR_SHARE = 0.25
"""The boundary is found clearly on a line where its standard deviation is within this share of the
window that it is sought in."""

SEEN_CONFIDENCE = 0.2
"""Clicks trusted less are guesses at hidden points, or the top of the hair."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Plausibility:
    """Agreement of the evidence with a fitted body.

    Attributes
    ----------
    overlap
        Intersection over union of the body's silhouette and the observed one.
    boundary
        Share of the body's outline along which the colours of the picture change clearly.
    beyond
        Area observed farther than :data:`BEYOND_M` from the body, over the body's own.
    outgrown_m
        Distance by which the person's own trunk or hips lie off the body, metres.
    click_deviations
        Root mean square distance of the seen points from the body's own, standard deviations.
    strain
        What pose and shape cost under their priors, nats.
    clothed
        Whether clothes may stand off the body: they overlap with any outline.
    detected
        Whether the detector finds a person where the points are; None if it was not asked.
    """

    overlap: float
    boundary: float
    beyond: float
    outgrown_m: float
    click_deviations: float
    strain: float
    clothed: bool
    detected: bool | None


def plausibility(
    observation: Observation,
    objective: Objective,
    candidate: Candidate,
    overlap: float,
    *,
    trunk: Mask,
    shape_nats: float,
) -> Plausibility:
    """Compare the body at the end of a search with the evidence of its objective.

    ``trunk`` (h, w) is nearest to trunk and hips; ``shape_nats`` is what the shape costs under its
    prior.
    """
    return Plausibility(
        overlap=overlap,
        boundary=_clear_boundary(observation, objective, candidate),
        beyond=_beyond(objective, candidate),
        outgrown_m=outgrown_m(
            objective.evidence.silhouette, candidate.rendering, trunk, observation.display
        ),
        click_deviations=_click_deviations(objective, candidate),
        strain=candidate.energies["pose_prior"] + shape_nats,
        clothed=objective.evidence.clothes is not None,
        detected=observation.detected,
    )


HEAD_ROWS = (0.5, 0.6, 0.7, 0.8)
"""Rows of the head's part at which heads are compared, from crown to lower end: below most hair."""


def head_breadth(objective: Objective, candidate: Candidate) -> float | None:
    """Breadth of the head in the picture, of the body's own; None where no head is seen.

    Bodies become broader with the person, and heads hardly.
    """
    model, faces = objective.operators.model, candidate.rendering.face_ids
    head = (faces >= 0) & (model.part_of_triangle[faces] == model.part_names.index("head"))
    rows = np.flatnonzero(head.any(axis=1))
    if not len(rows):
        return None
    shares: list[float] = []
    for row in (int(rows[0] + share * (rows[-1] - rows[0])) for share in HEAD_ROWS):
        own, seen = head[row], objective.evidence.silhouette.mask[row]
        if not own.any():
            continue
        middle = int(np.flatnonzero(own).mean())
        beside = np.flatnonzero(~seen)
        left = beside[beside < middle].max(initial=-1)
        right = beside[beside > middle].min(initial=len(seen))
        shares.append(float((right - left - 1) * seen[middle] / np.count_nonzero(own)))
    return float(np.median(shares)) if shares else None


def _clear_boundary(observation: Observation, objective: Objective, candidate: Candidate) -> float:
    """A caller's mask does not hide what the picture shows: lines are then placed here."""
    pixels_per_metre = objective.scales.pixels_per_metre
    window = max(round(WINDOW_M * pixels_per_metre), LEAST_WINDOW_PX)
    if objective.evidence.lines is None:
        objective = with_lines_about(objective, candidate, observation.display)
    lines = objective.evidence.lines
    if lines is None or not len(lines.variances):
        return 0.0
    return float(np.mean(np.sqrt(lines.variances) < CLEAR_SHARE * window))


def _beyond(objective: Objective, candidate: Candidate) -> float:
    body = candidate.rendering.silhouette
    distance = cv2.distanceTransform((~body).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    silhouette = objective.evidence.silhouette
    # Loose clothes may reach as far as the outline is searched for.
    reach_m = BEYOND_M if silhouette.cloth is None else FARTHEST_M
    far = distance > reach_m * objective.scales.pixels_per_metre
    return float(np.count_nonzero(silhouette.mask & far) / max(np.count_nonzero(body), 1))


def _click_deviations(objective: Objective, candidate: Candidate) -> float:
    clicks = objective.evidence.clicks
    seen = clicks.confidence > SEEN_CONFIDENCE
    if not seen.any():
        return 0.0
    distances = np.linalg.norm(
        objective.evidence.camera.project(candidate.landmarks) - clicks.clicks, axis=1
    )
    return float(np.sqrt(np.mean((distances / clicks.sigma(objective.scales))[seen] ** 2)))
