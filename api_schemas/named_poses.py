"""Poses by name, which several kinds of derivations know."""

from enum import StrEnum


class NamedPose(StrEnum):
    """Poses by name; ``rest`` is the body model's own, with half-raised arms."""

    REST = "rest"
    STANDING = "standing"
    A_POSE = "a_pose"
    T_POSE = "t_pose"
    RELAXED = "relaxed"
    WALKING = "walking"
    SITTING = "sitting"
    ARMS_RAISED = "arms_raised"
