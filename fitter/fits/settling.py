"""How every fit ends: from the final bodies to a person with light in each picture."""

from collections.abc import Sequence
from dataclasses import replace

from fitter.capture.checking import check_capture
from fitter.energies.objective import Objective
from fitter.fits.capture_check import capture_of_fit
from fitter.fits.contradiction import contradiction
from fitter.fits.obstruction import obstruction
from fitter.fits.outlined import Outlined, Subject
from fitter.fits.plausibility import plausibility
from fitter.fits.reporting import outcome_of
from fitter.fits.search import Found, LitView
from fitter.fits.worn_clothing import clothes_are_guessed, with_ease
from fitter.optimizer.hidden_reflectance import albedo_rgb
from fitter.optimizer.uncertainty import Certainty, camera_tilt, certainty, shape_covariance
from fitter.person.fitted_person import FittedPerson
from fitter.result import PictureFit
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.outcomes import Verdict


def settle(
    gender: Gender, subject: Subject, pictures: Sequence[Outlined], found: Found
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
    picture: Outlined,
    lit: LitView,
    found: Found,
    objective: Objective,
    certain: Certainty,
) -> PictureFit:
    observation, known, body = picture.observation, subject.known, certain.candidate
    overlap = objective.overlap(body)
    figures = plausibility(
        observation,
        objective,
        body,
        overlap,
        shape_nats=found.minimum.candidate.energies["shape_prior"],
    )
    contradicted = contradiction(figures)
    clothing = with_ease(objective.evidence.worn, objective, certain)
    seen = None if clothes_are_guessed(objective, observation.clothing.both) else clothing
    checked = check_capture(capture_of_fit(picture, known.height_m, body, seen))
    model = objective.operators.model
    obstructed = obstruction(
        objective.evidence.silhouette,
        body.rendering,
        model.part_of_triangle,
        model.part_names,
        scale=observation.scale,
    )
    findings = (*contradicted.findings, *checked.findings, *obstructed)
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


def _with_light(person: FittedPerson, picture: Outlined, lit: LitView) -> FittedPerson:
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
