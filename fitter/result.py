"""What a fit gives back."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fitter.arrays import Image, Mask, Vertices
from fitter.capture.finding import Finding
from fitter.measurement.quantity import Measurement
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.remarks import Assumption, FitWarning
from fitter.render.camera import Camera, FocalLengthSource
from fitter.request import Cues, Facing, OptimizerKind, ViewKind
from fitter.segmentation.trimap import Trimap
from fitter.vocabulary.outcomes import FacingSource, Outcome, Verdict

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
    Verdict.IMPLAUSIBLE: (
        "A body was fitted, but the picture contradicts it. See whether the points are on the "
        "right joints of one person, and whether a mask that was sent shows this person alone."
    ),
    Verdict.NO_PERSON: (
        "The picture shows no person where the points are. Click the joints of a person, or send "
        "another picture."
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbFacing:
    """How a limb's depth ambiguity was resolved (section 3.1).

    ``alternative_energy`` is the best energy found with the limb facing the other way, None where
    no such hypothesis was tried; ``ambiguous`` says that the two are close.
    """

    limb: str
    facing: Facing
    source: FacingSource
    ambiguous: bool
    alternative_energy: float | None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StageBody:
    """The body at the end of a stage: ``initial``, ``SE`` or ``SES``.

    Vertices are in the camera frame (posed) and the body frame (canonical), metres.
    """

    name: str
    body: BodyParameters
    posed_vertices: Vertices
    canonical_vertices: Vertices
    energies: Mapping[str, float]
    silhouette_overlap: float
    measurements: tuple[Measurement, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pictures:
    """Arrays the picture artifacts are drawn from, on the working picture (h, w).

    ``trimap`` holds :class:`~fitter.segmentation.trimap.TrimapLabel`; None where the caller sent a
    mask.
    """

    image: Image
    trimap: Trimap | None
    segmentation: Mask


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PictureFit:
    """The person as found in one picture.

    ``posed_vertices`` lie in the camera frame, metres. ``contradictions`` says in sentences what
    in the picture contradicts a person; empty where the verdict is that it is plausible.
    """

    person: FittedPerson
    height_m: float
    cues: Cues
    outcome: Outcome
    posed_vertices: Vertices
    silhouette_overlap: float
    verdict: Verdict = Verdict.PLAUSIBLE
    contradictions: tuple[str, ...] = ()

    @property
    def is_plausible(self) -> bool:
        """Whether nothing contradicts that a person was measured."""
        return self.verdict is Verdict.PLAUSIBLE

    @property
    def outcome_explanation(self) -> str:
        """What the outcome means; if a person is contradicted, what to do and by what."""
        if self.is_plausible:
            return OUTCOME_EXPLANATIONS[self.outcome]
        return " ".join((VERDICT_EXPLANATIONS[self.verdict], *self.contradictions))


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
    findings
        What is wrong with a picture that was taken to be measured; empty where ``kind`` is None.
    assumptions, warnings
        What was assumed of this picture, and what to look at in it.
    """

    kind: ViewKind | None
    found: PictureFit
    camera: Camera
    focal_length_source: FocalLengthSource
    limb_facing: tuple[LimbFacing, ...]
    findings: tuple[Finding, ...]
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
    pictures: Pictures


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
    """The whole result of a fit.

    ``given`` names the measurements the request gave, its height as stature. ``camera`` refers to
    the working picture. ``canonical_vertices`` are in the body frame, metres. ``stage_seconds`` is
    wall time by stage name. ``measurements``, and those of stages, are empty where a person is
    contradicted and the request does not insist.
    """

    found: PictureFit
    given: tuple[str, ...]
    optimizer: OptimizerKind
    camera: Camera
    focal_length_source: FocalLengthSource
    canonical_vertices: Vertices
    energies: Mapping[str, float]
    evaluations: int
    stages: tuple[StageBody, ...]
    measurements: tuple[Measurement, ...]
    limb_facing: tuple[LimbFacing, ...]
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
    stage_seconds: Mapping[str, float]
    pictures: Pictures

    @property
    def person(self) -> FittedPerson:
        """Who was found."""
        return self.found.person


def before_shading(result: FitResult) -> FitResult | None:
    """The same fit as silhouette and edges left it, before shading moved the body (E1, not E2).

    None where shading was not used, so that this is the result itself. What is not of the body
    (evaluations, times, warnings) stays that of the whole fit.
    """
    if result.person.reflectance is None:
        return None
    stage = next((stage for stage in result.stages if stage.name == "SE"), None)
    if stage is None:
        return None
    return replace(
        result,
        found=replace(
            result.found,
            person=replace(
                result.person,
                body=stage.body,
                light=None,
                reflectance=None,
                albedo_rgb=None,
                shape_covariance=None,
            ),
            cues=Cues.SE,
            posed_vertices=stage.posed_vertices,
            silhouette_overlap=stage.silhouette_overlap,
        ),
        canonical_vertices=stage.canonical_vertices,
        energies=stage.energies,
        measurements=stage.measurements,
    )
