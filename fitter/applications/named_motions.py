"""Motions that ship with the package, by name: the walk, and two that stay on one spot.

Each is a few postures in clinical angles (:mod:`fitter.applications.poses`), within the ranges of
:mod:`fitter.body.joint_limits`. From one to the next joints move by the course of least jerk, as
people's hands do from point to point (T. Flash and N. Hogan, "The coordination of arm movements",
1985). Timing and postures are ours.

The curves are ours. They follow the course that gait laboratories publish for adults at their own
pace (D. A. Winter, "The Biomechanics and Motor Control of Human Gait", 1987), from the heel strike
at 0 to the next at 1: the thigh swings between 28 degrees forward and 16 back; the knee gives as it
takes the weight and flexes by 60 degrees as the foot leaves the ground at 0.62; the foot strikes
with the heel, lies flat, and rises over its toes. Arms swing against the legs, the chest against
the pelvis. A man of 1.80 m walks 1.26 m/s by them, his pelvis rises and falls by 3 cm, and the
swinging foot stays 18 mm clear of the ground.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from fitter.applications.motion import Cycle, Moment
from fitter.applications.poses import NAMED_POSES, Angles, Rig

STANDARD_GRAVITY = 9.80665

STRIDES_PER_PENDULUM = 0.60
"""Strides a second times the square root of leg length over gravity, over 2 pi times this: people
walk a little faster than their legs would swing by themselves (54 strides a minute at 0.9 m)."""


USUAL_STRIDES = 3


def stride_of(rig: Rig) -> Cycle:
    """Walking on the spot at a person's own pace, by the length of the leg.

    To be put on the ground (:mod:`fitter.applications.motion`). Frame 0 is a strike of the left
    heel.
    """
    leg_m = float(
        np.linalg.norm(rig.bone("left_thigh", "left_shin"))
        + np.linalg.norm(rig.bone("left_shin", "left_foot"))
    )
    return Cycle(
        duration_s=float(2.0 * np.pi * STRIDES_PER_PENDULUM * np.sqrt(leg_m / STANDARD_GRAVITY)),
        times=USUAL_STRIDES,
        moment=lambda phase: Moment(angles=stride_angles(phase)),
    )


def stride_angles(phase: float) -> dict[str, Angles]:
    """Angles of all parts at a phase of the stride; 0 is the left heel's strike."""
    cosine = float(np.cos(2.0 * np.pi * phase))
    angles = {
        # Left forward at its heel strike: the pelvis turns to the right, the chest to the left.
        "spine": Angles(flexion=2.0, twist=4.0 * cosine),
        "chest": Angles(flexion=1.0, twist=5.0 * cosine),
        "neck": Angles(flexion=4.0, twist=-2.5 * cosine),
        "head": Angles(twist=-2.5 * cosine),
    }
    for side, offset in (("left", 0.0), ("right", 0.5)):
        angles |= {f"{side}_{limb}": held for limb, held in _side(phase + offset).items()}
    return angles


def _side(phase: float) -> dict[str, Angles]:
    swing = float(np.cos(2.0 * np.pi * phase))
    thigh = 6.0 + 22.0 * swing
    knee = 4.0 + 13.0 * _bump(phase, 0.14, 0.075) + 62.0 * _bump(phase, 0.74, 0.115)
    sole = 14.0 * _bump(phase, 0.96, 0.06) - 55.0 * _bump(phase, 0.64, 0.085)
    return {
        "thigh": Angles(flexion=thigh, abduction=0.5, twist=6.0),
        "shin": Angles(flexion=knee),
        "foot": Angles(flexion=_ankle(sole - thigh + knee)),
        "upper_arm": Angles(flexion=-1.0 - 19.0 * swing, abduction=9.0),
        "forearm": Angles(flexion=22.0 - 11.0 * swing),
        "hand": Angles(flexion=4.0),
    }


def _ankle(wanted: float) -> float:
    """The ankle's flexion that holds the sole as wanted, as far as ankles go: 15 up, 24 down."""
    most = 15.0 if wanted > 0.0 else 24.0
    return most * float(np.tanh(wanted / most))


def _bump(phase: float, centre: float, width: float) -> float:
    """A smooth periodic hill of height one; ``width`` is about its standard deviation."""
    sharpness = 1.0 / (2.0 * np.pi * width) ** 2
    return float(np.exp(sharpness * (np.cos(2.0 * np.pi * (phase - centre)) - 1.0)))


Held = dict[str, Angles]

_STANDING: Held = dict(NAMED_POSES["standing"])


def least_jerk(share: float) -> float:
    """The way that is made of a movement in a share of its time: 10 s³ - 15 s⁴ + 6 s⁵."""
    return share**3 * (10.0 - 15.0 * share + 6.0 * share**2)


def _within(value: float, start: float, end: float) -> float:
    """Which share of a stretch has passed: 0 before it, 1 after it."""
    return min(1.0, max(0.0, (value - start) / (end - start)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """A posture and when it is reached; parts that are not named are held as when standing."""

    time_s: float
    held: Held


def _keyed(keys: Sequence[Key], *, duration_s: float, times: int) -> Cycle:
    """A motion by its postures; after the last it goes back to the first."""
    around = (*keys, Key(time_s=duration_s, held=keys[0].held))

    def moment(phase: float) -> Moment:
        time_s = phase * duration_s
        after = next(place for place, key in enumerate(around) if key.time_s > time_s)
        before, next_ = around[after - 1], around[after]
        share = least_jerk((time_s - before.time_s) / (next_.time_s - before.time_s))
        return Moment(angles=_between(_STANDING | before.held, _STANDING | next_.held, share))

    return Cycle(duration_s=duration_s, times=times, moment=moment)


def _between(first: Held, second: Held, share: float) -> dict[str, Angles]:
    still = Angles()
    return {
        part: _mixed(first.get(part, still), second.get(part, still), share)
        for part in (*first, *(part for part in second if part not in first))
    }


def _mixed(first: Angles, second: Angles, share: float) -> Angles:
    return Angles(
        flexion=first.flexion + share * (second.flexion - first.flexion),
        abduction=first.abduction + share * (second.abduction - first.abduction),
        twist=first.twist + share * (second.twist - first.twist),
    )


def _both(**limbs: Angles) -> dict[str, Angles]:
    return {f"{side}_{limb}": held for side in ("left", "right") for limb, held in limbs.items()}


def _waving(elbow: float, *, lean: float) -> dict[str, Angles]:
    """The right hand beside the head: the upper arm level and turned out, the elbow bent."""
    return {
        "right_upper_arm": Angles(flexion=6, abduction=84, twist=82),
        "right_forearm": Angles(flexion=elbow),
        "right_hand": Angles(abduction=0.25 * (elbow - 90.0), twist=-30),
        "chest": Angles(abduction=2),
        "head": Angles(abduction=lean),
    }


def _wave(_: Rig) -> Cycle:
    out, inward = _waving(68, lean=3), _waving(112, lean=4)
    swings = [Key(time_s=0.8 + 0.32 * place, held=(inward, out)[place % 2]) for place in range(7)]
    return _keyed(
        [Key(time_s=0.0, held={}), *swings, Key(time_s=3.7, held={})], duration_s=4.2, times=1
    )


_UPRIGHT = _both(thigh=Angles(abduction=7, twist=14), foot=Angles(twist=7))
"""Feet apart, before a squat."""

_SQUATTING = _both(
    upper_arm=Angles(flexion=132, abduction=8),
    forearm=Angles(flexion=8),
    thigh=Angles(flexion=104, abduction=10, twist=18),
    shin=Angles(flexion=95),
    foot=Angles(flexion=19, twist=8),
) | {
    "spine": Angles(flexion=14),
    "chest": Angles(flexion=7),
    "neck": Angles(flexion=-18),
    "head": Angles(flexion=-14),
}
"""Thighs level, arms forward for balance, the whole sole on the ground."""

SQUATTING_LEAN_DEG = 29.0

WIDER_DEG = 10.0
"""Four times by how much thighs go farther apart half-way down: feet stay where they are."""


def _squat(_: Rig) -> Cycle:
    def moment(phase: float) -> Moment:
        down, up = least_jerk(_within(phase, 0.10, 0.50)), least_jerk(_within(phase, 0.60, 1.0))
        depth = down - up
        angles = _between(_STANDING | _UPRIGHT, _STANDING | _SQUATTING, depth)
        wider = WIDER_DEG * depth * (1.0 - depth)
        for thigh in ("left_thigh", "right_thigh"):
            held = angles[thigh]
            angles[thigh] = replace(held, abduction=held.abduction + wider)
        return Moment(angles=angles, lean=SQUATTING_LEAN_DEG * depth)

    return Cycle(duration_s=2.9, times=2, moment=moment)


NAMED_MOTIONS: Mapping[str, Callable[[Rig], Cycle]] = MappingProxyType(
    {
        "walk": stride_of,
        "wave": _wave,
        "squat": _squat,
    }
)
"""By name, the motion of a person without end."""
