"""The camera's tilt and the person's stance, from the body alone: which way is up.

Nothing else in the picture is asked. What is known of people and of cameras:

- who *stands* has both ankles at one height, the centre of mass above the feet, the trunk upright
  and the knees straight;
- who *strides* or stands on one foot has the centre of mass near the middle between the ankles and
  the trunk upright, and one ankle may be higher;
- *others* (who jump, sit, lie or lean) do anything;
- cameras are held level, between a photographer's chest and eyes, or elsewhere.

With features f of the body under a tilt τ (pitch and roll), and the camera's height h:

    E(body) = min over τ of  - log Σ_k π_k N(f; m, Σ_k) - log Σ_c π_c N(h; μ, σ_c²) + ½ roll²/σ_r²

up to a constant that makes the least energy zero. The body is told to stand only as far as its kind
does: the shares of the kinds are those of a mixture, one of whose kinds reaches everything. The
tilt is no parameter of the body: its most probable value enters, so that the derivative by the body
is that at this tilt (envelope theorem), and the rows of the matrix have it eliminated (Schur).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points3D
from fitter.energies import _body_kernels as kernels
from fitter.energies.rows import Nuisance, PositionRows, Support
from fitter.numerics.damped_descent import Offer, damped_steps, descend
from fitter.vocabulary.choices import Posture
from fitter.vocabulary.outcomes import StanceKind


@dataclass(frozen=True, slots=True, kw_only=True)
class StanceSpreads:
    """Probability of a kind of stance, and the spreads of its features.

    Attributes
    ----------
    probability
        Before the body is seen.
    forward_m, sideways_m
        Centre of mass from the middle of the ankles, in the hips' directions.
    ankles_m, stride_m
        Difference of the ankles' heights, and how far one is before the other.
    bend, lean
        Sines of the angles by which the trunk leaves the vertical.
    knees
        Sum of 1 - cos of the angles by which the knees are bent.
    """

    probability: float
    forward_m: float
    sideways_m: float
    ankles_m: float
    stride_m: float
    bend: float
    lean: float
    knees: float


# Spreads of standing and striding are those of motion capture, rounded: 1,911 poses in which no
# ankle and no centre of mass moves faster than 25 cm/s, and 890 others with a foot on the floor,
# in 80 clips of mocap.cs.cmu.edu, a database created with funding from NSF EIA-0196217. Standing
# people bend forward by 0.14 there because many of them play ball; forward, 0.05 allows for people
# of another build than the one that was captured (0.026). Nobody sits or lies, so the
# spreads of all others are ours: 0.3 as a sine keeps a trunk from leaning back far to cover ground
# with its feet, which hardly changes an outline; who lies down is known by the clicks.
STANCES: Mapping[StanceKind, StanceSpreads] = {
    StanceKind.STANDING: StanceSpreads(
        probability=0.65,
        forward_m=0.05,
        sideways_m=0.065,
        ankles_m=0.025,
        stride_m=0.1,
        bend=0.14,
        lean=0.07,
        knees=0.2,
    ),
    StanceKind.STRIDING: StanceSpreads(
        probability=0.25,
        forward_m=0.07,
        sideways_m=0.045,
        ankles_m=0.1,
        stride_m=0.45,
        bend=0.11,
        lean=0.05,
        knees=0.4,
    ),
    StanceKind.OTHER: StanceSpreads(
        probability=0.1,
        forward_m=0.4,
        sideways_m=0.4,
        ankles_m=0.4,
        stride_m=0.4,
        bend=0.3,
        lean=0.3,
        knees=1.0,
    ),
}
"""By kind."""

MEASURED_STANDING = StanceSpreads(
    probability=0.9,
    forward_m=0.035,
    sideways_m=0.03,
    ankles_m=0.015,
    stride_m=0.06,
    bend=0.09,
    lean=0.04,
    knees=0.06,
)
"""Spreads of people asked to stand upright, straight and still: about half of what standing people
leave to chance. Nobody follows to the centimetre; half of these spreads gained no more."""

FORWARD_OF_ANKLES_M = 0.045
"""Centre of mass of quiet standing: D. A. Winter, "Human balance and posture control during
standing and walking", Gait & Posture 3 (1995); motion capture has 6 to 7 cm."""

ANKLE_HEIGHT_M = 0.08
CAMERA_HEIGHT_M = 1.35
CAMERA_SPREADS: tuple[tuple[float, float], ...] = ((0.7, 0.2), (0.3, 0.6))
"""Hand-held cameras are between the chest and the eyes of who holds them, 1.25 to 1.6 m, or lower
where they crouch or sit; the rest stand on a table, a stair or a tripod. Probability, metres."""

MEASURED_CAMERA_SPREADS: tuple[tuple[float, float], ...] = ((1.0, 0.6),)
"""Cameras for measuring stand where they can, and people are told to have them at the height of the
belly. A narrower spread leaned people toward such cameras: at 1.1 m they came out 0.7 kg lighter
still, from front and side (tuning half)."""

ROLL_SPREAD = np.radians(2.0)
"""People hold cameras level to a degree or two, and turn pictures that are not."""

_MOST_EVALUATIONS = 60
_LONGEST_TURN = 0.3
_SETTLED_NATS = 1e-9
"""A millionth of a radian: the gradient by the body is that at the most probable tilt."""

# Masses and centres of segments: D. A. Winter, "Biomechanics and Motor Control of Human Movement",
# table 4.1, trunk and head apart as in P. de Leva, J. Biomechanics 29 (1996).
_SEGMENTS: tuple[tuple[float, float, str, str], ...] = (
    (0.0271, 0.577, "upper_arm", "forearm"),
    (0.0162, 0.457, "forearm", "hand"),
    (0.0061, 0.0, "hand", "hand"),
    (0.1416, 0.41, "thigh", "shin"),
    (0.0433, 0.446, "shin", "foot"),
    (0.0137, 0.0, "foot", "foot"),
)
_TRUNK_MASS, _TRUNK_CENTRE, _HEAD_MASS = 0.435, 0.449, 0.069


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Tilt:
    """The most probable tilt under one body.

    Attributes
    ----------
    pitch, roll
        Radians; see :class:`fitter.parameters.CameraTilt`.
    energy
        Nats.
    shares
        Probability of each kind of stance, in the order of :class:`StanceKind`.
    posture
        What was known of the stance.
    """

    pitch: float
    roll: float
    energy: float
    shares: Float[np.ndarray, "3"]
    posture: Posture


@dataclass(frozen=True, slots=True, eq=False)
class _Weighed:
    """A tilt with its energy."""

    tilt: Float[np.ndarray, "2"]
    weighed: kernels.Weighed

    @property
    def total(self) -> float:
        return self.weighed.energy


def stance_vectors(part_names: tuple[str, ...]) -> Float[np.ndarray, "9 p"]:
    """Matrix that makes the nine vectors of a stance of the joints.

    Right to left hip; middle of the ankles to centre of mass; right to left ankle; middle of the
    hips to middle of the shoulders; middle of the ankles; left thigh, left shin, right thigh,
    right shin.
    """
    unit = dict(zip(part_names, np.eye(len(part_names)), strict=True))

    def middle(name: str) -> np.ndarray:
        return 0.5 * (unit[f"left_{name}"] + unit[f"right_{name}"])

    def across(name: str) -> np.ndarray:
        return unit[f"left_{name}"] - unit[f"right_{name}"]

    shoulders, hips = middle("upper_arm"), middle("thigh")
    mass = (
        _TRUNK_MASS * (shoulders + _TRUNK_CENTRE * (hips - shoulders)) + _HEAD_MASS * unit["head"]
    )
    for share, place, near, far in _SEGMENTS:
        mass = mass + 2.0 * share * (middle(near) + place * (middle(far) - middle(near)))
    ankles = middle("foot")
    return np.stack(
        [
            *(
                across("thigh"),
                mass / mass.sum() - ankles,
                across("foot"),
                shoulders - hips,
                ankles,
            ),
            *(
                unit[f"{side}_{far}"] - unit[f"{side}_{near}"]
                for side in ("left", "right")
                for near, far in (("thigh", "shin"), ("shin", "foot"))
            ),
        ]
    )


def most_probable_tilt(
    joints: Points3D, vectors: Float[np.ndarray, "9 p"], posture: Posture = Posture.ANY
) -> Tilt:
    """The tilt of least energy; joints (p, 3) in the camera frame."""
    stance, kinds = vectors @ joints, KINDS[posture]
    found = [_descended(stance, start, kinds) for start in _starts(stance)]
    best = min(found, key=lambda each: each.total)
    return Tilt(
        pitch=float(best.tilt[0]),
        roll=float(best.tilt[1]),
        energy=best.total,
        shares=best.weighed.shares.reshape(len(StanceKind), -1).sum(axis=1),
        posture=posture,
    )


def stance_rows(joints: Points3D, vectors: Float[np.ndarray, "9 p"], tilt: Tilt) -> PositionRows:
    """The energy at a body as rows over the joints, with pitch and roll as two more unknowns."""
    stance, place = vectors @ joints, np.array([tilt.pitch, tilt.roll])
    weighed = kernels.weigh(stance, place, KINDS[tilt.posture])
    by_vectors = kernels.slopes_by_vectors(stance, place)
    return PositionRows(
        residuals=weighed.departures,
        weights=weighed.weights,
        points=np.tile(np.arange(len(joints)), (9, 1)),
        derivatives=np.einsum("kvc,vp->kpc", by_vectors, vectors),
        support=Support.JOINTS,
        nuisance=Nuisance(
            name="tilt",
            slopes=kernels.slopes_by_tilt(stance, place),
            # The camera's usual roll and height are rows of their own.
            known=np.zeros((0, 2)),
        ),
    )


def _descended(
    stance: Float[np.ndarray, "9 3"], start: Float[np.ndarray, "2"], kinds: kernels.Kinds
) -> _Weighed:
    """The most probable tilt near one, with the shares of each step held.

    That is expectation and maximisation.
    """

    def paraboloid(now: _Weighed) -> Callable[[float], Offer[_Weighed]]:
        matrix, gradient = kernels.normal_equations(stance, now.tilt, now.weighed)
        return damped_steps(matrix, gradient, partial(_turned, stance, kinds, now), floor=0.0)

    found = descend(
        _weighed(stance, kinds, start),
        paraboloid,
        max_evaluations=_MOST_EVALUATIONS,
        settled=_SETTLED_NATS,
    )
    return found.point


def _weighed(
    stance: Float[np.ndarray, "9 3"], kinds: kernels.Kinds, tilt: Float[np.ndarray, "2"]
) -> _Weighed:
    return _Weighed(tilt, kernels.weigh(stance, tilt, kinds))


def _turned(
    stance: Float[np.ndarray, "9 3"],
    kinds: kernels.Kinds,
    now: _Weighed,
    step: Float[np.ndarray, "2"],
) -> _Weighed:
    """Pitch and roll after a step, which is shortened where it is long."""
    shortened = min(1.0, _LONGEST_TURN / max(float(np.abs(step).max()), 1e-12))
    return _weighed(stance, kinds, now.tilt + shortened * step)


def _starts(stance: Float[np.ndarray, "9 3"]) -> list[Float[np.ndarray, "2"]]:
    """A level camera, and one under which the centre of mass is above the ankles."""
    up = stance[kernels.BALANCE] / np.linalg.norm(stance[kernels.BALANCE])
    level = np.zeros(2)
    above = np.array([np.arcsin(up[2]), np.arctan2(-up[0], -up[1])])
    return [level, above]


def _kinds(
    spreads_of: Mapping[StanceKind, StanceSpreads], cameras: Sequence[tuple[float, float]]
) -> kernels.Kinds:
    means = np.array([FORWARD_OF_ANKLES_M, *[0.0] * 6, CAMERA_HEIGHT_M - ANKLE_HEIGHT_M, 0.0])
    pairs = [(spreads_of[kind], camera) for kind in StanceKind for camera in cameras]
    spreads = np.array(
        [
            [
                *(each.forward_m, each.sideways_m, each.ankles_m, each.stride_m),
                *(each.bend, each.lean, each.knees, height_m, ROLL_SPREAD),
            ]
            for each, (_, height_m) in pairs
        ]
    )
    probable = np.array([each.probability * camera for each, (camera, _) in pairs])
    probable /= probable.sum()
    offsets = np.log(spreads).sum(axis=1) - np.log(probable)
    # At the means the energy is zero, and nowhere is it less.
    return kernels.Kinds(means, spreads**-2, offsets + np.log(np.exp(-offsets).sum()))


KINDS: Mapping[Posture, kernels.Kinds] = {
    Posture.ANY: _kinds(STANCES, CAMERA_SPREADS),
    Posture.MEASURED: _kinds(
        {**STANCES, StanceKind.STANDING: MEASURED_STANDING}, MEASURED_CAMERA_SPREADS
    ),
}
"""Kinds of stance and camera, by what is known of the posture."""
