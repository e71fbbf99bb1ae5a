"""The walk that ships with the package.

The curves are ours. They follow the course that gait laboratories publish for adults at their own
pace (D. A. Winter, "The Biomechanics and Motor Control of Human Gait", 1987), from the heel strike
at 0 to the next at 1: the thigh swings between 28 degrees forward and 16 back; the knee gives as it
takes the weight and flexes by 60 degrees as the foot leaves the ground at 0.62; the foot strikes
with the heel, lies flat, and rises over its toes. Arms swing against the legs, the chest against
the pelvis. A man of 1.80 m walks 1.26 m/s by them, his pelvis rises and falls by 3 cm, and the
swinging foot stays 18 mm clear of the ground.
"""

import numpy as np

from fitter.applications.motion import Cycle
from fitter.applications.poses import Angles, Rig

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
        angles=stride_angles,
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
