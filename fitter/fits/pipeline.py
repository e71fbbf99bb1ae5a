"""The paper on one page: from pictures and clicks to a measured, posed and lit body."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Final

from fitter.arrays import Shape, ShapeCovariance
from fitter.energies.objective import JointCandidate
from fitter.energies.shape_terms import population_prior
from fitter.errors import InvalidInputError
from fitter.fits.clothing_report import clothing_warnings, with_what_clothes_cost
from fitter.fits.equipment import PACKAGED, Equipment
from fitter.fits.error_widening import hardly_known, widened_covariance
from fitter.fits.outline_search import PictureSearch, Subject, search_outline
from fitter.fits.paper import (
    differences,
    paper_picture,
    paper_search,
    with_all_terms,
    with_height_found,
    without_standard_errors,
)
from fitter.fits.picture_objective import of_person, prior_precision
from fitter.fits.progress import Observer, Stage, StageClock, ViewClock, ignore_progress
from fitter.fits.reporting import (
    fit_warnings,
    insistence_warnings,
    person_warnings,
    predict_given,
    shading_warnings,
)
from fitter.fits.search import Found, search
from fitter.fits.verdict import settle
from fitter.measurement.anthropometry import error_if_known, measure
from fitter.measurement.definitions import Measurement
from fitter.observation.subject import check_person
from fitter.optimizer.free_space import held_shape
from fitter.optimizer.uncertainty import certainty, shape_covariance
from fitter.person.several_pictures import CombinedShape, combined_shape
from fitter.population.known_person import known_person
from fitter.request import FitRequest, Paper, View
from fitter.result import FitResult, FitStage, FittedView, PictureFit, Pictures, StageBody
from fitter.vocabulary.choices import Cues, PaperEnergy
from fitter.vocabulary.measurements import WEIGHT
from fitter.vocabulary.remarks import Code

_WAIST: Final = "waist_girth_smallest"

MOST_VIEWS: Final = 6
"""Pictures of one fit."""


def fit(
    request: FitRequest,
    equipment: Equipment = PACKAGED,
    *,
    observer: Observer = ignore_progress,
) -> FitResult:
    """Fit one body to all pictures of a person: each by itself until near its outline, then all.

    Of what it raises :func:`fitter.library.fit` tells, which is this to callers.
    """
    _check(request)
    clock = StageClock(observer, len(request.views))
    with clock.stage(Stage.OBSERVATION):
        subject = _subject(request, equipment)
    paper = request.choices.paper
    alone = None
    if paper is None:
        pictures = _search_pictures(request, subject, equipment, clock)
        alone = _alone(subject, pictures)
        held = subject.known.attributes.held
        start = pictures[0].body.parameters.shape if alone is None else alone.shape
        found = search(pictures, subject.known, held_shape(held, start), request.choices, clock)
        judged = found
    else:
        try:
            pictures = [paper_picture(request.views[0], subject, request.choices, equipment, clock)]
        except InvalidInputError as error:
            place = "views.0"
            raise error.within(place) from error
        found = paper_search(pictures[0], subject, paper, request.choices.optimizer, clock)
        subject = with_height_found(subject, paper, found)
        judged = with_all_terms(subject, found)
    known = subject.known
    with clock.stage(Stage.MEASUREMENT):
        people = settle(request.person.gender, subject, pictures, judged)
        shape = found.minimum.candidate.shape
        if paper is None:
            people = _with_wider_errors(people, subject, shape)
        else:
            people = without_standard_errors(people)
        covariance = people[0].person.shape_covariance
        measurements = measure(
            subject.prepared.measuring,
            shape,
            shape_covariance=covariance,
            given=known.given,
            held=known.held,
        )
        people = _with_cost_of_clothes(people, subject, shape, measurements)
        stages = _stages(subject, pictures, found, people, measurements)
        population = subject.prepared.population
        warnings = person_warnings(
            alone,
            predict_given(judged.energy, judged.minimum.candidate, known),
            dict(zip(population.names, population.units, strict=True)),
            [view.kind for view in request.views],
            [each.person.body for each in people],
        )
        views = _views(request, pictures, found, people)
    hardly, withheld = (), set[str]()
    if not request.choices.force:
        findings = [found for each in people for found in each.findings]
        hardly = hardly_known(measurements, population, known, findings)
        withheld = {name for each in hardly for name in each.where}
        if not all(each.is_plausible for each in people):
            hardly, withheld = (), {each.name for each in measurements}
    return FitResult(
        views=views,
        shape=shape,
        shape_covariance=covariance,
        canonical_vertices=stages[-1].canonical_vertices,
        triangles=subject.prepared.operators.model.triangles,
        measurements=_without(withheld, measurements),
        given=known.given,
        optimizer=request.choices.optimizer,
        energies=found.minimum.candidate.energies,
        evaluations=found.evaluations + sum(each.evaluations for each in pictures),
        stages=tuple(
            replace(each, measurements=_without(withheld, each.measurements)) for each in stages
        ),
        alone=alone,
        assumptions=known.assumptions,
        warnings=known.warnings + warnings + hardly,
        stage_seconds=clock.seconds,
        differences=() if paper is None else differences(request.choices),
    )


def _check(request: FitRequest) -> None:
    if not 1 <= len(request.views) <= MOST_VIEWS:
        raise InvalidInputError(
            code="views-count",
            field="views",
            reason=f"A fit has 1 to {MOST_VIEWS} pictures, not {len(request.views)}.",
            remedy="Send the person from the front and from the side, and more if there are.",
        )
    paper = request.choices.paper
    if paper is not None and len(request.views) > 1:
        raise InvalidInputError(
            code="paper-one-picture",
            field="paper",
            reason="The paper fits one picture, from its clicks.",
            remedy="Send one picture, or leave `paper` out.",
        )
    if paper is not None and not any(_counted(paper, view) for view in request.views):
        raise InvalidInputError(
            code="wrong-length",
            field="paper.energies",
            reason="No term counts: shading counts with the cues `SES` alone.",
            remedy="Set `cues` to `SES`, or `paper.energies` to other terms as well.",
        )
    check_person(request.person)


def _counted(paper: Paper, view: View) -> frozenset[PaperEnergy]:
    """The terms that count, of which shading is one only where the cues say so."""
    return paper.energies - (set() if view.cues is Cues.SES else {PaperEnergy.SHADING})


def _subject(request: FitRequest, equipment: Equipment) -> Subject:
    prepared = equipment.model(request.person.gender)
    known = known_person(request.person, prepared.population, prepared.operators.evaluator)
    return Subject(prepared=prepared, known=known)


def _search_pictures(
    request: FitRequest, subject: Subject, equipment: Equipment, clock: StageClock
) -> list[PictureSearch]:
    """Every picture by itself."""
    is_only = len(request.views) == 1
    pictures: list[PictureSearch] = []
    for number, view in enumerate(request.views):
        detector = equipment.detector_for(view)
        of_view = ViewClock(clock=clock, view=number)
        try:
            pictures.append(
                search_outline(view, subject, request.choices, detector, of_view, is_only=is_only)
            )
        except InvalidInputError as error:
            place = f"views.{number}"
            raise error.within(place) from error
    return pictures


def _alone(subject: Subject, pictures: Sequence[PictureSearch]) -> CombinedShape | None:
    """Shape as the outlines of several pictures say it, each by itself."""
    if len(pictures) == 1:
        return None
    covariances: list[ShapeCovariance] = []
    prior = prior_precision([each.objective for each in pictures])
    for picture in pictures:
        about = of_person(subject.known, [picture.about(picture.objective, picture.body)])
        about = replace(about, shape_prior=population_prior(len(subject.known.shape), prior))
        (certain,) = certainty(about, about.evaluate([picture.body]))
        covariances.append(shape_covariance(certain, height_variance=subject.known.height_variance))
    shapes = [each.body.parameters.shape for each in pictures]
    return combined_shape(shapes, covariances, prior=prior)


def _with_wider_errors(
    people: Sequence[PictureFit], subject: Subject, shape: Shape
) -> tuple[PictureFit, ...]:
    """The same, less sure of their shape by what harms the pictures."""
    covariance = people[0].person.shape_covariance
    assert covariance is not None
    wider = widened_covariance(
        covariance,
        subject.prepared.measuring,
        shape,
        [each.findings for each in people],
        subject.known.given,
    )
    return tuple(
        replace(each, person=replace(each.person, shape_covariance=wider)) for each in people
    )


def _with_cost_of_clothes(
    people: Sequence[PictureFit],
    subject: Subject,
    shape: Shape,
    measurements: Sequence[Measurement],
) -> tuple[PictureFit, ...]:
    """The same; where loose clothes hide somebody, it is said what that costs."""
    findings = [found for each in people for found in each.findings]
    if not any(found.code == Code.CLOTHES_LOOSE for found in findings):
        return tuple(people)
    covariance = people[0].person.shape_covariance
    assert covariance is not None
    known = subject.known.given
    waist = next(each.standard_error for each in measurements if each.name == _WAIST)
    weighed = None
    if waist is not None and WEIGHT not in known and _WAIST not in known:
        weighed = waist * error_if_known(
            subject.prepared.measuring, shape, covariance, of=_WAIST, known=WEIGHT
        )
    return tuple(
        replace(each, findings=with_what_clothes_cost(each.findings, waist, weighed))
        for each in people
    )


def _without(
    withheld: Collection[str], measurements: Sequence[Measurement]
) -> tuple[Measurement, ...]:
    return tuple(each for each in measurements if each.name not in withheld)


def _stages(
    subject: Subject,
    pictures: Sequence[PictureSearch],
    found: Found,
    people: Sequence[PictureFit],
    measurements: Sequence[Measurement],
) -> list[FitStage]:
    """Stages of the body: before any search, after E1, and after E2 if there was shading."""
    shape = pictures[0].initial.shape
    initial = [replace(each.initial, shape=shape) for each in pictures]
    before = {"initial": found.objective.evaluate(initial)}
    if found.is_lit:
        before["SE"] = found.outline.candidate
    stages = [_stage(subject, found, name, candidate) for name, candidate in before.items()]
    final = found.minimum.candidate
    stages.append(
        FitStage(
            name="SES" if found.is_lit else "SE",
            bodies=tuple(
                StageBody(
                    body=each.person.body,
                    posed_vertices=each.posed_vertices,
                    silhouette_overlap=each.silhouette_overlap,
                )
                for each in people
            ),
            canonical_vertices=subject.prepared.measuring.canonical.at(final.shape),
            energies=final.energies,
            measurements=tuple(replace(each, standard_error=None) for each in measurements),
        )
    )
    return stages


def _stage(subject: Subject, found: Found, name: str, candidate: JointCandidate) -> FitStage:
    prepared = subject.prepared
    return FitStage(
        name=name,
        bodies=tuple(
            StageBody(
                body=each.parameters,
                posed_vertices=prepared.operators.evaluator.vertices(each.parameters),
                silhouette_overlap=view.overlap(each),
            )
            for view, each in zip(found.objective.views, candidate.views, strict=True)
        ),
        canonical_vertices=prepared.measuring.canonical.at(candidate.shape),
        energies=candidate.energies,
        measurements=measure(prepared.measuring, candidate.shape),
    )


def _views(
    request: FitRequest,
    pictures: Sequence[PictureSearch],
    found: Found,
    people: Sequence[PictureFit],
) -> tuple[FittedView, ...]:
    views: list[FittedView] = []
    for picture, objective, each in zip(pictures, found.objective.views, people, strict=True):
        observation, view = picture.observation, picture.view
        views.append(
            FittedView(
                kind=view.kind,
                found=each,
                camera=observation.camera,
                focal_length_source=observation.focal_length_source,
                limb_facing=picture.limb_facing,
                assumptions=observation.assumptions,
                warnings=observation.warnings
                + picture.segmentation.warnings
                + clothing_warnings(objective, observation.clothing.both)
                + fit_warnings(each.silhouette_overlap, picture.limb_facing)
                + shading_warnings(view, each)
                + insistence_warnings(request.choices, each),
                pictures=Pictures(
                    image=observation.display,
                    trimap=picture.trimap,
                    segmentation=picture.segmentation.mask,
                ),
            )
        )
    return tuple(views)
