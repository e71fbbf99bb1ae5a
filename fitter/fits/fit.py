"""A fit of one to six pictures of a person."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from fitter.arrays import Shape, ShapeCovariance, Triangles, Vertices
from fitter.fits import pipeline
from fitter.fits.equipment import Equipment
from fitter.fits.progress import Observer, Progress, ignore_progress
from fitter.fits.scan import ScanProgress, ScanView, scan
from fitter.measurement.quantity import Measurement
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import CombinedShape
from fitter.remarks import Assumption, FitWarning
from fitter.request import Choices, OptimizerKind, Person, Posture, View, ViewKind
from fitter.request import FitRequest as PictureRequest
from fitter.result import FitResult as PictureResult
from fitter.result import FitStage, FittedView, PictureFit


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FitRequest:
    """One person and the pictures of them: one to six."""

    person: Person
    views: tuple[View, ...]
    choices: Choices = field(default_factory=Choices)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FitResult:
    """One person, and how they stand in each picture.

    Attributes
    ----------
    views
        The pictures in the order of the request.
    shape, shape_covariance
        (n,), (n, n) the shape that the bodies in all pictures have, and how certain it is.
    canonical_vertices, triangles
        The body in the canonical pose, body frame, metres; the triangles of its vertices.
    measurements
        Empty where a picture contradicts that it shows a person and the request does not insist.
    given
        Names of the measurements the request gave, its height as stature.
    energies
        By term, of all pictures together.
    evaluations
        True energies computed, of one picture or of all together.
    stages
        How the body came about.
    alone
        What several pictures say of the shape, each by itself; None of one picture.
    assumptions, warnings
        What was assumed of the person, and what to look at in the fit as a whole.
    stage_seconds
        Wall time by stage name.
    """

    views: tuple[FittedView, ...]
    shape: Shape
    shape_covariance: ShapeCovariance
    canonical_vertices: Vertices
    triangles: Triangles
    measurements: tuple[Measurement, ...]
    given: tuple[str, ...]
    optimizer: OptimizerKind
    energies: Mapping[str, float]
    evaluations: int
    stages: tuple[FitStage, ...]
    alone: CombinedShape | None
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
    stage_seconds: Mapping[str, float]

    @property
    def found(self) -> PictureFit:
        """The person in the first picture, or the only one."""
        return self.views[0].found

    @property
    def person(self) -> FittedPerson:
        """Who was found, as they stand in the first picture."""
        return self.found.person


def fit(
    request: FitRequest,
    equipment: Equipment = Equipment(),  # noqa: B008
    *,
    observer: Observer = ignore_progress,
) -> FitResult:
    """Fit one body to all pictures of a person.

    Raises
    ------
    InvalidInputError
        If the request cannot be used; the message names the field and the remedy. Where there are
        several pictures, the field of a picture's fault begins with ``views.NUMBER``.
    ModelFileError
        If the body model is missing or damaged, or lacks something a fit needs.
    DetectorUnavailableError
        If points are to be proposed and the detector is not installed.
    """
    if len(request.views) == 1:
        return _of_one(request, equipment, observer)
    return _of_several(request, equipment, observer)


def _picture_request(request: FitRequest, view: View) -> PictureRequest:
    person, choices = request.person, request.choices
    told = view.kind not in (None, ViewKind.OTHER)
    return PictureRequest(
        image=view.image,
        clicks=view.clicks,
        gender=person.gender,
        height_m=person.height_m,
        measurements=person.measurements,
        focal_length_px=view.focal_length_px,
        focal_length_35mm=view.focal_length_35mm,
        cues=view.cues,
        optimizer=choices.optimizer,
        outline=choices.outline,
        clothing=view.clothing,
        posture=Posture.MEASURED if told else Posture.ANY,
        light=view.light,
        limb_facing=view.limb_facing,
        complete_clicks=view.complete_clicks,
        segmentation=view.segmentation,
        slant_hints=view.slant_hints,
        mask=view.mask,
        force=choices.force,
        max_pixels=choices.max_pixels,
    )


def _of_one(request: FitRequest, equipment: Equipment, observer: Observer) -> FitResult:
    (view,) = request.views
    found: PictureResult = pipeline.fit(
        _picture_request(request, view),
        models=equipment.models,
        detector_weights=equipment.detector_weights,
        observer=observer,
    )
    covariance = found.person.shape_covariance
    assert covariance is not None
    return FitResult(
        views=(
            FittedView(
                kind=view.kind,
                found=found.found,
                camera=found.camera,
                focal_length_source=found.focal_length_source,
                limb_facing=found.limb_facing,
                findings=(),
                assumptions=found.assumptions,
                warnings=found.warnings,
                pictures=found.pictures,
            ),
        ),
        shape=found.person.body.shape,
        shape_covariance=covariance,
        canonical_vertices=found.canonical_vertices,
        triangles=equipment.model(request.person.gender).operators.model.triangles,
        measurements=found.measurements,
        given=found.given,
        optimizer=found.optimizer,
        energies=found.energies,
        evaluations=found.evaluations,
        stages=tuple(
            FitStage(
                name=stage.name,
                bodies=(stage,),
                canonical_vertices=stage.canonical_vertices,
                energies=stage.energies,
                measurements=stage.measurements,
            )
            for stage in found.stages
        ),
        alone=None,
        assumptions=(),
        warnings=(),
        stage_seconds=found.stage_seconds,
    )


def _of_several(request: FitRequest, equipment: Equipment, observer: Observer) -> FitResult:
    def report(progress: ScanProgress) -> None:
        observer(Progress(stage=progress.stage, fraction=progress.fraction, view=progress.view))

    found = scan(
        [
            ScanView(kind=view.kind or ViewKind.OTHER, request=_picture_request(request, view))
            for view in request.views
        ],
        models=equipment.models,
        detector_weights=equipment.detector_weights,
        observe=report,
    )
    return FitResult(
        views=tuple(
            FittedView(
                kind=asked.kind,
                found=view.found,
                camera=view.camera,
                focal_length_source=view.focal_length_source,
                limb_facing=(),
                findings=() if asked.kind is None else view.findings,
                assumptions=view.assumptions,
                warnings=view.warnings,
                pictures=view.pictures,
            )
            for asked, view in zip(request.views, found.views, strict=True)
        ),
        shape=found.shape,
        shape_covariance=found.covariance,
        canonical_vertices=found.canonical_vertices,
        triangles=equipment.model(request.person.gender).operators.model.triangles,
        measurements=found.measurements,
        given=found.given,
        optimizer=request.choices.optimizer,
        energies={},
        evaluations=0,
        stages=(),
        alone=found.alone,
        assumptions=found.assumptions,
        warnings=found.warnings,
        stage_seconds={},
    )
