"""Stances made different from one another: mirrored, with room for a big body, unsteady."""

from dataclasses import fields, replace
from typing import TypeVar

import numpy as np

from tests.accuracy.scene import Arm, Leg, Stance

JITTER_DEGREES = 3.0
"""Standard deviation of most angles."""

STEADY = {"heel_up", "bend", "curl"}
"""Angles of legs and hands that decide about the floor and about fists; bends vary by a share."""

BEND_SHARE = 0.08

INWARD_SHARE = 1.3
"""Degrees by which a forearm before the trunk gives way for each by which its arm is raised."""

Limb = TypeVar("Limb", Arm, Leg)
Angles = tuple[float, float, float]


def mirrored(stance: Stance) -> Stance:
    """Left and right exchanged."""
    turned = {name: _mirrored(getattr(stance, name)) for name in _TRUNK}
    return replace(
        stance,
        facing=-stance.facing,
        left_arm=stance.right_arm,
        right_arm=stance.left_arm,
        left_leg=stance.right_leg,
        right_leg=stance.left_leg,
        free_leg="left" if stance.free_leg == "right" else "right",
        **turned,
    )


def opened(stance: Stance, *, arms: float, legs: float) -> Stance:
    """Arms and legs raised farther, in degrees, as bodies need where they are thick; arms turned
    inward are turned so much less."""
    return replace(
        stance,
        left_arm=_opened_arm(stance.left_arm, arms),
        right_arm=_opened_arm(stance.right_arm, arms),
        left_leg=replace(stance.left_leg, raised=stance.left_leg.raised + legs),
        right_leg=replace(stance.right_leg, raised=stance.right_leg.raised + legs),
    )


def unsteady(stance: Stance, rng: np.random.Generator) -> Stance:
    """Every angle a little different."""
    return replace(
        stance,
        facing=_near(stance.facing, 2.0, rng),
        **{name: _trunk_near(getattr(stance, name), rng) for name in _TRUNK},
        left_arm=_limb_near(stance.left_arm, rng),
        right_arm=_limb_near(stance.right_arm, rng),
        left_leg=_limb_near(stance.left_leg, rng, share=0.3),
        right_leg=_limb_near(stance.right_leg, rng, share=0.3),
    )


_TRUNK = ("pelvis", "spine", "chest", "neck", "head")


def _opened_arm(arm: Arm, degrees: float) -> Arm:
    turn = min(arm.turn + INWARD_SHARE * degrees, 0.0) if arm.turn < 0.0 else arm.turn
    return replace(arm, raised=arm.raised + degrees, turn=turn)


def _mirrored(angles: Angles) -> Angles:
    bend, turn, lean = angles
    return (bend, -turn, -lean)


def _trunk_near(angles: Angles, rng: np.random.Generator) -> Angles:
    bend, turn, lean = (_near(angle, 0.4, rng) for angle in angles)
    return (bend, turn, lean)


def _limb_near(limb: Limb, rng: np.random.Generator, *, share: float = 1.0) -> Limb:
    changed = {
        each.name: _near(getattr(limb, each.name), share, rng)
        for each in fields(limb)
        if each.name not in STEADY
    }
    bend = limb.bend * (1.0 + BEND_SHARE * _clipped(rng))
    return replace(limb, bend=round(bend, 1), **changed)


def _near(angle: float, share: float, rng: np.random.Generator) -> float:
    return round(angle + share * JITTER_DEGREES * _clipped(rng), 1)


def _clipped(rng: np.random.Generator) -> float:
    return float(np.clip(rng.normal(), -1.5, 1.5))
