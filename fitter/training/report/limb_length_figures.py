"""Limb lengths predicted from gender and height (section 3.1) beside the survey's.

The mean person of a height has the height coefficient alone; limb lengths follow as linear
combinations of vertices. The survey's answer is its fields' mean among people of that stature. The
models' people are civilians and heavier than the survey's soldiers, which moves some lengths, such
as the crotch's height: so besides, the survey's mean among people of that stature and weight.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape, Vector3
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices, shape_for_height, standing_vertices
from fitter.body.skeleton import regress
from fitter.numerics.meshes import enclosed_volume
from fitter.training.people.subject_fit import DENSITY_KG_PER_M3
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.training.surveys.survey_moments import (
    SurveyMoments,
    load_moments,
    packaged_moments_path,
)

HEIGHTS = 50
REACH_DEVIATIONS = 2.326
"""From the 1st to the 99th percentile of the survey's stature."""

Points = Mapping[str, Vector3]


class ComparedLimb(NamedTuple):
    """A length of the model and the sum of survey fields that stands for it.

    ``length_m`` takes the points at rest and in the standing pose. ``difference`` says why the two
    differ by a constant, and is empty where they are the same length.
    """

    name: str
    length_m: Callable[[Points, Points], float]
    fields: Mapping[str, float]
    difference: str


def _between(*names: str) -> Callable[[Points, Points], float]:
    """Straight from point to point at rest; names joined by a plus sign stand for their mean."""

    def length(rest: Points, standing: Points) -> float:
        del standing
        way = np.stack(
            [np.mean([rest[part] for part in name.split("+")], axis=0) for name in names]
        )
        return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())

    return length


def _height(name: str) -> Callable[[Points, Points], float]:
    """Above the soles, standing."""

    def length(rest: Points, standing: Points) -> float:
        del rest
        sole = 0.5 * (standing["sole_left"][1] + standing["sole_right"][1])
        return float(standing[name][1] - sole)

    return length


LIMBS = (
    ComparedLimb(
        "upper arm", _between("left_acromion", "left_elbow"), {"acromionradialelength": 1.0}, ""
    ),
    ComparedLimb(
        "forearm",
        _between("left_elbow", "left_wrist"),
        {"radialestylionlength": 1.0},
        "from the elbow's centre, not the radius's head",
    ),
    ComparedLimb(
        "hand",
        _between("left_wrist", "left_finger_tip"),
        {"handlength": 1.0},
        "straight to the tip of fingers bent a little",
    ),
    ComparedLimb(
        "thigh",
        _between("left_hip", "left_knee"),
        {"trochanterionheight": 1.0, "lateralfemoralepicondyleheight": -1.0},
        "from the hip's centre, not the trochanter's top",
    ),
    ComparedLimb(
        "shin",
        _between("left_knee", "left_ankle"),
        {"lateralfemoralepicondyleheight": 1.0, "lateralmalleolusheight": -1.0},
        "to the ankle's centre, not the malleolus",
    ),
    ComparedLimb("foot", _between("left_heel", "left_toe"), {"footlength": 1.0}, ""),
    ComparedLimb("knee height", _height("left_knee"), {"lateralfemoralepicondyleheight": 1.0}, ""),
    ComparedLimb("crotch height", _height("crotch"), {"crotchheight": 1.0}, ""),
    ComparedLimb("nape height", _height("cervicale"), {"cervicaleheight": 1.0}, ""),
    ComparedLimb(
        "trunk",
        _between("left_hip+right_hip", "left_shoulder+right_shoulder"),
        {"acromialheight": 1.0, "trochanterionheight": -1.0},
        "to the shoulders' centres, below the acromia",
    ),
    ComparedLimb(
        "shoulders across",
        _between("left_acromion", "right_acromion"),
        {"biacromialbreadth": 1.0},
        "",
    ),
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LimbLengthFigures:
    """Predicted lengths of c limbs at h heights, centimetres.

    Attributes
    ----------
    heights
        (h,) statures from the survey's 1st to its 99th percentile.
    predicted, surveyed
        (h, c) by the model from the height alone, and the survey's mean at that stature.
    surveyed_alike
        (h, c) the survey's mean at that stature and the predicted body's weight.
    correlation
        (c,) of the survey's length with stature: how much a height can tell.
    """

    limbs: tuple[ComparedLimb, ...]
    heights: Float[np.ndarray, " h"]
    predicted: Float[np.ndarray, "h c"]
    surveyed: Float[np.ndarray, "h c"]
    surveyed_alike: Float[np.ndarray, "h c"]
    correlation: Float[np.ndarray, " c"]

    @property
    def errors_mm(self) -> Float[np.ndarray, "h c"]:
        """Predicted less surveyed, less their mean where the two are not the same length."""
        errors = 10.0 * (self.predicted - self.surveyed)
        differ = np.array([bool(limb.difference) for limb in self.limbs])
        return errors - np.where(differ, errors.mean(axis=0), 0.0)

    @property
    def offsets_mm(self) -> Float[np.ndarray, " c"]:
        """Predicted less surveyed, mean over the heights."""
        return 10.0 * (self.predicted - self.surveyed).mean(axis=0)

    @property
    def alike_offsets_mm(self) -> Float[np.ndarray, " c"]:
        """The same less people of that stature and weight."""
        return 10.0 * (self.predicted - self.surveyed_alike).mean(axis=0)

    @property
    def slopes(self) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, " c"]]:
        """Gain of length by stature, of the model and of the survey."""
        span = self.heights[-1] - self.heights[0]
        return tuple((each[-1] - each[0]) / span for each in (self.predicted, self.surveyed))


def limb_length_figures(
    model: BodyModel, survey: SurveyMoments, count: int = HEIGHTS
) -> LimbLengthFigures:
    """Predict all limbs at heights from the survey's 1st to its 99th percentile.

    Parameters
    ----------
    model
        Of one gender; ``survey`` is of the same.
    count
        Heights, evenly spaced.
    """
    evaluator = ScapeEvaluator(model)
    mean, covariance = survey.of(
        [{"stature": 1.0}, {"weightkg": 1.0}, *(limb.fields for limb in LIMBS)]
    )
    deviation = np.sqrt(np.diagonal(covariance))
    heights = mean[0] + REACH_DEVIATIONS * deviation[0] * np.linspace(-1.0, 1.0, count)
    shapes = [shape_for_height(evaluator, height / 100.0) for height in heights]
    weights = [
        DENSITY_KG_PER_M3 * enclosed_volume(rest_vertices(model, shape), model.triangles)
        for shape in shapes
    ]
    given = np.stack([heights, np.array(weights)], axis=1) - mean[:2]
    return LimbLengthFigures(
        limbs=LIMBS,
        heights=heights,
        predicted=100.0 * np.array([_predicted(evaluator, shape) for shape in shapes]),
        surveyed=mean[2:] + given[:, :1] * covariance[0, 2:] / covariance[0, 0],
        surveyed_alike=mean[2:] + given @ np.linalg.solve(covariance[:2, :2], covariance[:2, 2:]),
        correlation=covariance[0, 2:] / (deviation[0] * deviation[2:]),
    )


def limb_length_lines(reported: Reported) -> tuple[str, ...]:
    """The section of the report."""
    gender = reported.model.gender
    figures = limb_length_figures(reported.model, load_moments(packaged_moments_path(), gender))
    errors = np.abs(figures.errors_mm)
    model_slopes, survey_slopes = figures.slopes
    rows = [
        (
            limb.name,
            f"{figures.surveyed[:, k].mean():.1f}",
            f"{figures.offsets_mm[k]:+.1f}",
            f"{errors[:, k].mean():.1f}",
            f"{errors[:, k].max():.1f}",
            f"{figures.alike_offsets_mm[k]:+.1f}",
            f"{model_slopes[k]:.3f}",
            f"{survey_slopes[k]:.3f}",
            f"{figures.correlation[k]:.2f}",
            limb.difference,
        )
        for k, limb in enumerate(figures.limbs)
    ]
    heads = (
        "",
        "survey, cm",
        "mean off, mm",
        "mean abs",
        "largest",
        "off people as heavy",
        "per cm of stature",
        "survey's",
        "correlation",
        "",
    )
    title = (
        f"limb lengths from height alone (section 3.1), {len(figures.heights)} heights from "
        f"{figures.heights[0]:.0f} to {figures.heights[-1]:.0f} cm, beside ANSUR II's"
    )
    return (
        *table_lines(title, heads, rows),
        *note_lines(
            "Where the last column names a difference of definition, mean absolute and largest "
            "error are about the mean offset. Off people as heavy: off the survey's mean at that "
            "stature and the predicted body's weight, soldiers being lighter. Correlation: of the "
            "survey's length with stature."
        ),
    )


def _predicted(evaluator: ScapeEvaluator, shape: Shape) -> list[float]:
    landmarks = evaluator.model.landmarks
    rest, standing = (
        dict(zip(landmarks.names, regress(landmarks, vertices), strict=True))
        for vertices in (rest_vertices(evaluator.model, shape), standing_vertices(evaluator, shape))
    )
    return [limb.length_m(rest, standing) for limb in LIMBS]
