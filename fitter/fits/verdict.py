"""The end of every fit: from the final bodies to a person with light in each picture.

The bounds were chosen on the tuning halves of people and of nonsense (DECISIONS.md, "Nonsense is
called nonsense"). No person may come near them, in the dark, in grain, behind a table or with
careless clicks: a circle that is measured is laughed about, a person who is refused has no remedy.

The outline was doubted about the first body near the person
(:mod:`fitter.evidence.doubtful_outline`), and standard errors have grown by that. Here it is told.
Doubt spreads by colours, from a shadow at the feet up a leg too. So it is told only of a body that
what is taken for the person contradicts beside or on what is measured.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import Integer, Shaped

from fitter.arrays import Mask
from fitter.capture.capture import Capture
from fitter.capture.checking import check_capture
from fitter.capture.clothes import listed
from fitter.capture.posture import LEAST_FRONTAL, facing
from fitter.energies.objective import Objective
from fitter.evidence.doubtful_outline import off_the_body, scale_of
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.fits.capture_check import capture_of_fit
from fitter.fits.clothing_report import clothes_are_guessed, with_ease, with_what_is_worn
from fitter.fits.outline_search import PictureSearch, Subject
from fitter.fits.plausibility import Plausibility, head_breadth, plausibility
from fitter.fits.reporting import POOR_OVERLAP, outcome_of
from fitter.fits.search import Found, LitView
from fitter.optimizer.hidden_reflectance import albedo_rgb
from fitter.optimizer.uncertainty import Certainty, camera_tilt, certainty, shape_covariance
from fitter.person.fitted_person import FittedPerson
from fitter.render.rasterizer import Rendering
from fitter.result import PictureFit
from fitter.segmentation.skin_colour import nearest_of
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.remarks import Code, Remark, Severity, remark


def settle(
    gender: Gender, subject: Subject, pictures: Sequence[PictureSearch], found: Found
) -> tuple[PictureFit, ...]:
    """The person in each picture, with light, reflectance and the shape's covariance."""
    energy, candidate = found.energy, found.minimum.candidate
    return tuple(
        _settled(gender, subject, picture, lit, found, view, certain)
        for picture, lit, view, certain in zip(
            pictures, found.views, energy.views, certainty(energy, candidate), strict=True
        )
    )


def _settled(
    gender: Gender,
    subject: Subject,
    picture: PictureSearch,
    lit: LitView,
    found: Found,
    objective: Objective,
    certain: Certainty,
) -> PictureFit:
    observation, known, body = picture.observation, subject.known, certain.candidate
    overlap = objective.overlap(body)
    model = objective.operators.model
    parts = nearest_parts(body.rendering, model.part_of_triangle, model.part_names)
    figures = plausibility(
        observation,
        objective,
        body,
        overlap,
        trunk=np.isin(parts, ("trunk", "hips")),
        shape_nats=found.minimum.candidate.energies["shape_prior"],
    )
    contradicted = contradiction(figures)
    clothing = with_ease(objective.evidence.worn, objective, certain)
    seen = None if clothes_are_guessed(objective, observation.clothing.both) else clothing
    capture = capture_of_fit(picture, known.height_m, body, seen)
    checked = check_capture(capture)
    findings = (*contradicted.findings, *checked.findings)
    if not is_outgrown(figures):
        findings += obstruction(objective.evidence.silhouette, body.rendering, parts)
    breadth = head_breadth(objective, body)
    findings += squeezed(capture, breadth, dressed=objective.evidence.clothes is not None)
    findings = with_what_is_worn(findings, objective, body)
    verdict = contradicted.verdict
    if verdict is Verdict.PLAUSIBLE and not checked.usable:
        verdict = Verdict.IMPLAUSIBLE
    return PictureFit(
        person=_with_light(
            FittedPerson(
                gender=gender,
                model_checksum=subject.prepared.operators.model.checksum,
                body=body.parameters,
                camera=observation.image_camera,
                light=None,
                reflectance=None,
                albedo_rgb=None,
                shape_covariance=shape_covariance(certain, height_variance=known.height_variance),
                tilt=camera_tilt(certain),
            ),
            picture,
            lit,
        ),
        height_m=known.height_m,
        cues=picture.view.cues,
        outcome=outcome_of(converged=found.minimum.converged, overlap=overlap, verdict=verdict),
        posed_vertices=objective.operators.whole_vertices(body.parameters),
        silhouette_overlap=overlap,
        verdict=verdict,
        findings=findings,
        clothing=clothing,
    )


def _with_light(person: FittedPerson, picture: PictureSearch, lit: LitView) -> FittedPerson:
    shading = lit.shading
    if shading is None:
        return person
    return replace(
        person,
        light=shading.light,
        reflectance=shading.reflectance,
        albedo_rgb=albedo_rgb(
            shading.body,
            shading.reflectance.albedo,
            picture.observation.linear_rgb,
            lit.intensity,
            shading.hidden,
        ),
    )


BAD_OVERLAP: Final = 0.78
ELSEWHERE_OVERLAP: Final = 0.3
"""With less the body and the mask are in different places; a table hides half a person."""

USUAL_BOUNDARY, LITTLE_BOUNDARY = 0.46, 0.22
"""Midway between nonsense and people on the tuning halves: 0.36 and 0.56 below a bad overlap, 0.09
and 0.35 below a poor one."""

MOST_BEYOND: Final = 0.2
"""Hair and skirts are at most 0.01 of the body; a second person in a mask is 0.8 and more."""

MOST_OUTGROWN_M: Final = 0.04
"""Largest distance accepted of a person's own trunk or hips off the body: of 81 pictures of people
in underwear (tuning half) none has more than 0.015. Bellies that the model cannot reach, and that
come out smaller the bigger they are, have 0.085 and more; those that it reaches have none."""

MOST_CLICK_DEVIATIONS: Final = 4.0
"""Points that are off by 3 % of the picture's height reach 3.3, points under wrong names 4.6."""

POOR_CLICK_DEVIATIONS: Final = 1.8
SOME_STRAIN, MUCH_STRAIN = 14.0, 25.0
"""Nats, under the priors of pose and shape. A body stretched over an animal's shape costs 17 and
more, that of a person seen as badly at most 11. An animal's joints are 2.2 standard deviations off
a body of 34 nats; an athlete's body costs 26, with points that are off by 1.0."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contradiction:
    """The verdict on a fit, and what contradicts a person: nothing, or one finding that blocks."""

    verdict: Verdict = Verdict.PLAUSIBLE
    findings: tuple[Remark, ...] = ()


def contradiction(found: Plausibility) -> Contradiction:
    """Judge a fit by how it agrees with the evidence."""
    is_empty = found.boundary < _least_boundary(found)
    is_no_body = (
        found.overlap < POOR_OVERLAP
        and found.click_deviations > POOR_CLICK_DEVIATIONS
        and found.strain > MUCH_STRAIN
    )
    is_elsewhere = found.overlap < ELSEWHERE_OVERLAP
    is_more = found.beyond > MOST_BEYOND
    is_muddled = found.click_deviations > MOST_CLICK_DEVIATIONS
    is_unusual = is_outgrown(found)
    other = is_empty or is_no_body or is_elsewhere or is_more or is_muddled
    if not (other or is_unusual):
        return Contradiction()
    nobody = found.detected is False or (is_empty and not found.detected)
    said = {
        "The detector finds no person where the points are.": found.detected is False,
        f"The picture changes clearly along {found.boundary:.0%} of the body's outline; along a "
        "person's it does along more than half.": is_empty,
        f"The body and what was taken for the person overlap by {found.overlap:.0%}; with people "
        "it is about nine tenths.": is_empty or is_no_body or is_elsewhere,
        "What was taken for the person has parts that are not the body's, "
        f"{found.beyond:.0%} of its size: somebody or something else.": is_more,
        f"Trunk or hips lie up to {100.0 * found.outgrown_m:.0f} cm outside the body, in the "
        "person's own colours: the bodies that were learned do not reach so far.": is_unusual,
        f"The points lie {found.click_deviations:.1f} standard deviations off the body's own; a "
        "person's lie within about one.": is_no_body or is_muddled,
        "The points ask for a pose or a shape that people hardly have.": is_no_body,
    }
    verdict = Verdict.NO_PERSON if nobody else Verdict.IMPLAUSIBLE
    finding = remark(
        Code.CONTRADICTED,
        " ".join(sentence for sentence, holds in said.items() if holds),
        severity=Severity.BLOCKS,
    )
    return Contradiction(verdict=verdict, findings=(finding,))


def is_outgrown(found: Plausibility) -> bool:
    """Whether a person's trunk or hips are beyond what the model can be: an unusual person.

    Nothing that covers them need be there, and no error of the model says how far it is off.
    """
    return found.outgrown_m > MOST_OUTGROWN_M


def _least_boundary(found: Plausibility) -> float:
    """Share of the outline that must be seen, if the silhouette is no person's either.

    People hardly told from the wall have a good silhouette, people half hidden a clear outline. In
    loose clothes every silhouette is good.
    """
    if found.overlap >= POOR_OVERLAP:
        if found.detected or not found.clothed:
            return 0.0
        return LITTLE_BOUNDARY if found.detected is None else USUAL_BOUNDARY
    is_bad = found.overlap < BAD_OVERLAP
    if found.detected:
        return LITTLE_BOUNDARY if is_bad else 0.0
    if found.detected is False or is_bad or found.strain > SOME_STRAIN:
        return USUAL_BOUNDARY
    return LITTLE_BOUNDARY


PARTS: Final[Mapping[str, frozenset[str]]] = {
    "trunk": frozenset({"chest", "spine"}),
    "hips": frozenset({"pelvis"}),
    "thighs": frozenset({"thigh"}),
    "lower legs": frozenset({"shin"}),
    "arms": frozenset({"arm", "forearm"}),
}
"""By the last word of the names of the body model's parts. At head, hands and feet hair, what is
held, shoes and shadows are usual."""

LEAST_OFF_M2: Final = 4e-3
"""Area that contradicts the body, at its distance, from which on it is told. Of 236 fits of the
tuning half, clicked and proposed, people as they are have less but for 4, on bricks or with a
shadow; the least behind a box or an arm is 4.5e-3."""

LEAST_SHARE: Final = 0.05
"""Least share of a part's outline that must be touched for the part to be named."""


def obstruction(
    silhouette: SilhouetteEvidence,
    rendering: Rendering,
    parts: Shaped[np.ndarray, "h w"],
) -> tuple[Remark, ...]:
    """Finding of things before the person or beside them, if there are any.

    Parameters
    ----------
    silhouette
        With no confidence where it was doubted.
    rendering
        The body as it was found in the picture.
    parts
        From :func:`nearest_parts`.
    """
    doubtful = silhouette.doubtful
    if not doubtful.any() or not rendering.silhouette.any():
        return ()
    spilt, missed = off_the_body(silhouette, rendering, doubtful)
    # An arm where none is seen is the body's own mistake more often than a thing before it.
    off = (spilt & (parts != "")) | (missed & (parts != "") & (parts != "arms"))
    if np.count_nonzero(off) < LEAST_OFF_M2 * scale_of(rendering) ** 2:
        return ()
    outline = _outline(rendering.silhouette)
    shares = {
        name: float(np.mean(doubtful[of_part]))
        for name in PARTS
        if (of_part := outline & (parts == name)).any()
    }
    told = {name: share for name, share in shares.items() if share >= LEAST_SHARE}
    if not told:
        return ()
    said = [f"{100.0 * share:.0f} % at the {name}" for name, share in told.items()]
    return (
        remark(
            Code.COVERED,
            "Something covers the person, touches their outline or looks like them: of the "
            f"outline {listed(said)} does not count.",
            severity=Severity.HARMS,
        ),
    )


NARROW_HEAD, BROAD_HEAD = 0.92, 1.1
"""Breadth of a head, of the body's, seen from the front: 0.95 to 1.06 of twenty people, 1.11 to 1.3
of those squeezed to 0.75 of their height, 0.82 to 0.92 of those stretched to 1.3 (tuning half)."""

NARROW_DRESSED = 0.073
"""Breadth times distance of the ears of the dressed, whose own breadth is hidden: 16 real people in
two outfits have 0.075 or more, of these 32 pictures, stretched to 1.3, 17 are found."""

NEAR_EARS, FAR_EARS = 0.092, 0.1035
"""Distance of the ears, of the stature: the median of people from the front (tuning half), and more
than 16 real people have whose heads seem broad. Long hair broadens a head, and moves no ears. Of
twelve people squeezed to 0.75 ten are found."""


def squeezed(capture: Capture, breadth: float | None, *, dressed: bool) -> tuple[Remark, ...]:
    """Finding of a picture that was squeezed or stretched, if it was, of who faces the camera.

    ``breadth`` is that of the head, of the body's; ``dressed`` whether loose clothes hide that.
    """
    ears = [capture.joints.get(f"{side}_ear") for side in ("left", "right")]
    if not breadth or ears[0] is None or ears[1] is None or capture.stature_px is None:
        return ()
    if (facing(capture) or 0.0) < LEAST_FRONTAL:
        return ()
    apart = float(np.linalg.norm(ears[0] - ears[1])) / capture.stature_px
    is_broad = breadth > BROAD_HEAD and apart > FAR_EARS
    is_narrow = breadth < NARROW_HEAD and apart < NEAR_EARS
    if dressed:
        is_narrow &= breadth * apart < NARROW_DRESSED
    if not (is_broad or is_narrow):
        return ()
    return (
        remark(
            Code.SQUEEZED,
            f"The head is {breadth:.2f} times as broad as that of a body as tall and heavy: the "
            f"picture seems to be {'squeezed' if is_broad else 'stretched'} from top to bottom.",
            severity=Severity.HARMS,
            where=("left_ear", "right_ear"),
        ),
    )


def nearest_parts(
    rendering: Rendering, part_of_triangle: Integer[np.ndarray, " f"], part_names: Sequence[str]
) -> Shaped[np.ndarray, "h w"]:
    """The one of :data:`PARTS` that each pixel shows or is nearest to; empty for head, hands, feet.

    ``part_of_triangle`` are indices into the names of the body model's parts.
    """
    kinds = [name.rpartition("_")[2] for name in part_names]
    named = np.array(
        [next((part for part, of in PARTS.items() if kind in of), "") for kind in kinds]
    )
    seen = named[part_of_triangle[rendering.face_ids]]
    return seen.ravel()[nearest_of(rendering.silhouette)]


def _outline(silhouette: Mask) -> Mask:
    """(h, w) the outermost pixels; the picture's own border bounds nothing."""
    region = silhouette.astype(np.uint8)
    return silhouette & (cv2.erode(region, np.ones((3, 3), np.uint8)) == 0)
