"""A scan: one person measured from several pictures that were taken for it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape, Vertices
from fitter.capture.checking import check_capture
from fitter.capture.finding import Finding
from fitter.errors import InvalidInputError
from fitter.fits.capture_check import capture_of_view
from fitter.fits.joint_search import JointlyFound, search_jointly
from fitter.fits.joint_view import view_of
from fitter.fits.outlined import Outlined, outlined
from fitter.fits.progress import Progress, Stage
from fitter.fits.reporting import insistence_warnings, shading_warnings
from fitter.fits.scan_remarks import scan_warnings
from fitter.fits.stage_clock import StageClock
from fitter.measurement.anthropometry import measure
from fitter.measurement.quantity import Measurement
from fitter.optimizer.free_space import held_shape
from fitter.optimizer.uncertainty import certainty, shape_covariance
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import CombinedShape, combined_shape
from fitter.remarks import Assumption, FitWarning
from fitter.render.camera import Camera, FocalLengthSource
from fitter.request import FitRequest, Posture, ViewKind
from fitter.result import PictureFit, Pictures

LEAST_VIEWS, MOST_VIEWS = 2, 6

ALONE_SHARE = 0.45
"""Share of the work that is done once every picture has been searched by itself."""

# Each report of a search takes this share of what is left: their number is not known in advance.
_STEP_SHARE = 0.03


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ScanView:
    """One picture of a scan; its request says the same of the person as all others."""

    kind: ViewKind
    request: FitRequest


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanProgress:
    """One report.

    ``view`` is the picture that is searched by itself, None where all are searched together;
    ``fraction`` the share of the scan done so far, in [0, 1], never decreasing.
    """

    view: int | None
    stage: Stage
    fraction: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ScannedView:
    """The person in one of the pictures.

    ``findings`` is what is wrong with the picture as one to measure by; ``camera`` refers to the
    working picture.
    """

    kind: ViewKind
    findings: tuple[Finding, ...]
    found: PictureFit
    camera: Camera
    focal_length_source: FocalLengthSource
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
    pictures: Pictures


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ScanResult:
    """One person.

    Attributes
    ----------
    shape, covariance
        (n,) coefficients and their (n, n) covariance.
    canonical_vertices
        Body frame, metres.
    views
        In the order of the request.
    measurements
        Empty where a picture contradicts that it shows a person and nobody insists.
    given
        Names of the measurements that the request gave, the height as stature.
    alone
        What the pictures say of the shape, each by itself.
    assumptions, warnings
        What was assumed of the person, and what to look at in the scan as a whole.
    """

    shape: Shape
    covariance: Float[np.ndarray, "n n"]
    canonical_vertices: Vertices
    views: tuple[ScannedView, ...]
    measurements: tuple[Measurement, ...]
    given: tuple[str, ...]
    alone: CombinedShape
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]


def scan(
    views: Sequence[ScanView],
    *,
    models: Path | None = None,
    detector_weights: Path | None = None,
    observe: Callable[[ScanProgress], None] = lambda _: None,
) -> ScanResult:
    """Fit one body to all pictures: each by itself until near its outline, then all together.

    Raises
    ------
    InvalidInputError
        If there are too few or too many pictures, they say different things of the person, or one
        cannot be used: its field then begins with ``views.NUMBER``.
    ModelFileError, DetectorUnavailableError
        As :func:`fitter.fits.pipeline.fit` does.
    """
    _check(views)
    pictures: list[Outlined] = []
    for number, view in enumerate(views):
        clock = StageClock(_of_view(number, len(views), observe))
        try:
            pictures.append(
                outlined(
                    _posed(view),
                    clock,
                    models=models,
                    detector_weights=detector_weights,
                    one_of_several=True,
                )
            )
        except InvalidInputError as error:
            raise of_view(number, error) from error
    known, prepared = pictures[0].known, pictures[0].prepared
    alone = combined_shape([_alone(picture) for picture in pictures])
    done = ALONE_SHARE

    def report(_: object) -> None:
        nonlocal done
        done += _STEP_SHARE * (1.0 - done)
        observe(ScanProgress(view=None, stage=Stage.SHADING, fraction=done))

    found = search_jointly(
        [view_of(picture) for picture in pictures],
        known,
        held_shape(known.attributes.held, alone.shape),
        report,
    )
    plausible = all(each.is_plausible for each in found.pictures)
    insisted = any(view.request.force for view in views)
    return ScanResult(
        shape=found.shape,
        covariance=found.covariance,
        canonical_vertices=prepared.measuring.canonical.at(found.shape),
        views=_scanned(views, pictures, found),
        measurements=measure(
            prepared.measuring,
            found.shape,
            shape_covariance=found.covariance,
            given=known.given,
            held=known.held,
        )
        if plausible or insisted
        else (),
        given=known.given,
        alone=alone,
        assumptions=known.assumptions,
        warnings=known.warnings
        + scan_warnings(
            alone,
            found.foretold,
            dict(zip(prepared.population.names, prepared.population.units, strict=True)),
            [view.kind for view in views],
            [each.person.body for each in found.pictures],
        ),
    )


def of_view(number: int, error: InvalidInputError) -> InvalidInputError:
    """The same error with the number of the picture at fault before its field."""
    return InvalidInputError(
        code=error.code,
        field=f"views.{number}.{error.field}",
        reason=error.reason,
        remedy=error.remedy,
    )


def _findings(view: ScanView, picture: Outlined) -> tuple[Finding, ...]:
    """What the checks of a capture say of a view's picture, which is measured all the same."""
    capture = capture_of_view(picture.observation, view.request, view.kind)
    return check_capture(capture).findings


def _posed(view: ScanView) -> FitRequest:
    """Who is measured stands as asked; in other pictures people do as they like."""
    if view.kind is ViewKind.OTHER:
        return view.request
    return replace(view.request, posture=Posture.MEASURED)


def _check(views: Sequence[ScanView]) -> None:
    if not LEAST_VIEWS <= len(views) <= MOST_VIEWS:
        raise InvalidInputError(
            code="views-count",
            field="views",
            reason=f"A scan has {LEAST_VIEWS} to {MOST_VIEWS} pictures, not {len(views)}.",
            remedy="Send the person from the front and from the side, and more if there are.",
        )
    first = views[0].request
    for number, view in enumerate(views):
        each = view.request
        said = (each.gender, each.height_m, each.measurements)
        if said != (first.gender, first.height_m, first.measurements):
            raise InvalidInputError(
                code="views-differ",
                field=f"views.{number}",
                reason="Views say different heights, genders or measurements of the person.",
                remedy="Say the same of the person in all views.",
            )


def _of_view(
    number: int, count: int, observe: Callable[[ScanProgress], None]
) -> Callable[[Progress], None]:
    """Progress of one picture as that of the scan; a picture's own goes as far as its outline."""

    def report(progress: Progress) -> None:
        within = min(progress.fraction / ALONE_SHARE, 1.0)
        observe(
            ScanProgress(
                view=number,
                stage=progress.stage,
                fraction=ALONE_SHARE * (number + within) / count,
            )
        )

    return report


def _alone(picture: Outlined) -> FittedPerson:
    """The person as the outline of one picture tells them."""
    body = picture.minimum.candidate
    about = picture.searches.about(picture.objective, body)
    covariance = shape_covariance(
        certainty(about, body), height_variance=picture.known.height_variance
    )
    return FittedPerson(
        gender=picture.request.gender,
        model_checksum=picture.prepared.operators.model.checksum,
        body=body.parameters,
        camera=picture.observation.image_camera,
        light=None,
        reflectance=None,
        albedo_rgb=None,
        shape_covariance=covariance,
    )


def _scanned(
    views: Sequence[ScanView],
    pictures: Sequence[Outlined],
    found: JointlyFound,
) -> tuple[ScannedView, ...]:
    return tuple(
        ScannedView(
            kind=view.kind,
            findings=_findings(view, picture),
            found=body,
            camera=picture.observation.camera,
            focal_length_source=picture.observation.focal_length_source,
            assumptions=picture.observation.assumptions,
            warnings=picture.observation.warnings
            + picture.segmentation.warnings
            + shading_warnings(view.request, body)
            + insistence_warnings(view.request, body),
            pictures=Pictures(
                image=picture.observation.display,
                trimap=picture.trimap,
                segmentation=picture.segmentation.mask,
            ),
        )
        for view, picture, body in zip(views, pictures, found.pictures, strict=True)
    )
