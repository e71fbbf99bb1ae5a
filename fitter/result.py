"""Result of a fit."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fitter.arrays import Image, Mask, Shape, ShapeCovariance, Triangles, Vertices
from fitter.measurement.definitions import Measurement
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import CombinedShape
from fitter.render.camera import Camera
from fitter.segmentation.trimap import Trimap
from fitter.vocabulary.choices import Cues, OptimizerKind, ViewKind
from fitter.vocabulary.outcomes import FocalLengthSource, LimbFacing, Outcome, Verdict, WornRegion
from fitter.vocabulary.remarks import Remark, Severity

OUTCOME_EXPLANATIONS: Mapping[Outcome, str] = {
    Outcome.CONVERGED: "The energy stopped decreasing.",
    Outcome.EVALUATION_LIMIT: (
        "The limit of evaluations was reached before the energy stopped decreasing; the best body "
        "found is returned."
    ),
    Outcome.POOR_FIT: (
        "The body found does not cover the person's silhouette well; the points, the gender or the "
        "segmentation may be wrong. The best body found is returned."
    ),
}


VERDICT_EXPLANATIONS: Mapping[Verdict, str] = {
    Verdict.IMPLAUSIBLE: "A body was fitted, but this picture cannot be measured.",
    Verdict.NO_PERSON: "The picture shows no person where the points are.",
}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StageBody:
    """The body in one picture at the end of a stage; vertices in the camera frame, metres."""

    body: BodyParameters
    posed_vertices: Vertices
    silhouette_overlap: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pictures:
    """Arrays that pictures of the result are drawn from, on the working picture (h, w).

    ``trimap`` holds :class:`~fitter.segmentation.trimap.TrimapLabel`; None where the caller sent a
    mask.
    """

    image: Image
    trimap: Trimap | None
    segmentation: Mask


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PictureFit:
    """The person as found in one picture.

    ``posed_vertices`` lie in the camera frame, metres. ``findings`` is what is wrong with the
    picture; where one blocks, the verdict is not that it is plausible. ``clothing`` is how each
    region is covered; empty where it was said that all clothes are tight.
    """

    person: FittedPerson
    height_m: float
    cues: Cues
    outcome: Outcome
    posed_vertices: Vertices
    silhouette_overlap: float
    verdict: Verdict = Verdict.PLAUSIBLE
    findings: tuple[Remark, ...] = ()
    clothing: tuple[WornRegion, ...] = ()

    @property
    def is_plausible(self) -> bool:
        """Whether nothing contradicts that a person was measured."""
        return self.verdict is Verdict.PLAUSIBLE

    @property
    def outcome_explanation(self) -> str:
        """Meaning of the outcome; where nothing is measured, by which findings, and what to do."""
        if self.is_plausible:
            return OUTCOME_EXPLANATIONS[self.outcome]
        blocking = [each for each in self.findings if each.severity is Severity.BLOCKS]
        said = [f"{each.code}: {each.text}" for each in blocking]
        return " ".join((VERDICT_EXPLANATIONS[self.verdict], *said))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FittedView:
    """One of the pictures of a fit, and the person in it.

    Attributes
    ----------
    kind
        As it was announced.
    found
        The person in this picture.
    camera
        Of the working picture.
    limb_facing
        How each limb's depth ambiguity was resolved; empty where the search began with a body.
    assumptions, warnings
        What was assumed of this picture, and what to look at in it.
    """

    kind: ViewKind | None
    found: PictureFit
    camera: Camera
    focal_length_source: FocalLengthSource
    limb_facing: tuple[LimbFacing, ...]
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]
    pictures: Pictures

    @property
    def findings(self) -> tuple[Remark, ...]:
        """Faults of the picture, what blocks first."""
        return self.found.findings


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FitStage:
    """One person at the end of a stage: ``initial``, ``SE`` or ``SES``.

    Attributes
    ----------
    bodies
        In each picture.
    canonical_vertices
        Of the shape they have in common, body frame, metres.
    energies
        By term, of all pictures together.
    """

    name: str
    bodies: tuple[StageBody, ...]
    canonical_vertices: Vertices
    energies: Mapping[str, float]
    measurements: tuple[Measurement, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FitResult:
    """One person, and how they stand in each picture.

    Attributes
    ----------
    views
        The pictures in the order of the request.
    shape, shape_covariance
        (n,), (n, n) the shape that the bodies in all pictures have, and how certain it is, less
        where findings harm; the paper's own method does not say.
    canonical_vertices, triangles
        The body in the canonical pose, body frame, metres; the triangles of its vertices.
    measurements
        Empty where a finding of a picture blocks and the request does not insist, without what a
        warning says is hardly known; with wider standard errors where findings harm.
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
    differences
        What still differs from the paper, of a fit that was to be the paper's own.
    """

    views: tuple[FittedView, ...]
    shape: Shape
    shape_covariance: ShapeCovariance | None
    canonical_vertices: Vertices
    triangles: Triangles
    measurements: tuple[Measurement, ...]
    given: tuple[str, ...]
    optimizer: OptimizerKind
    energies: Mapping[str, float]
    evaluations: int
    stages: tuple[FitStage, ...]
    alone: CombinedShape | None
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]
    stage_seconds: Mapping[str, float]
    differences: tuple[str, ...] = ()

    @property
    def found(self) -> PictureFit:
        """The person in the first picture, or the only one."""
        return self.views[0].found

    @property
    def person(self) -> FittedPerson:
        """The person that was found, as they stand in the first picture."""
        return self.found.person


def before_shading(result: FitResult) -> FitResult | None:
    """The same fit as silhouette and edges left it, before shading moved the bodies (E1, not E2).

    None where shading was not used, so that this is the result itself. What is not of the bodies
    (evaluations, times, warnings) stays that of the whole fit.
    """
    stage = next((stage for stage in result.stages if stage.name == "SE"), None)
    if stage is None or stage is result.stages[-1]:
        return None
    return replace(
        result,
        views=tuple(
            replace(
                view,
                found=replace(
                    view.found,
                    person=replace(
                        view.found.person,
                        body=each.body,
                        light=None,
                        reflectance=None,
                        albedo_rgb=None,
                        shape_covariance=None,
                    ),
                    cues=Cues.SE,
                    posed_vertices=each.posed_vertices,
                    silhouette_overlap=each.silhouette_overlap,
                ),
            )
            for view, each in zip(result.views, stage.bodies, strict=True)
        ),
        shape=stage.bodies[0].body.shape,
        canonical_vertices=stage.canonical_vertices,
        energies=stage.energies,
        measurements=stage.measurements,
    )
