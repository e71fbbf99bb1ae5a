"""A motion that repeats itself, and the frames of a stretch of it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from fitter.applications.motion import Motion
from fitter.applications.poses import Angles, angled_pose
from fitter.applications.rig import Rig
from fitter.arrays import Vector3
from fitter.numerics.rotations import rotation_matrices, rotation_vectors

FRAMES_PER_SECOND = 30.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """How a person is held at a moment.

    Attributes
    ----------
    angles
        By part; parts that are not named are held as at rest.
    turn, lean
        Of the pelvis, degrees: about the vertical to the person's left, then forward.
    lift_m
        How far the lowest point of the body is above the ground.
    """

    angles: Mapping[str, Angles]
    turn: float = 0.0
    lean: float = 0.0
    lift_m: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycle:
    """A motion that repeats itself.

    Attributes
    ----------
    duration_s
        Until it begins anew.
    times
        How often it is shown where nothing else is asked for.
    moment
        By phase, which is 0 where it begins and 1 where it begins anew.
    """

    duration_s: float
    times: int
    moment: Callable[[float], Moment]

    @property
    def frames(self) -> int:
        """In how many it is shown, at about 30 a second."""
        return max(2, round(self.duration_s * FRAMES_PER_SECOND))

    @property
    def frame_time_s(self) -> float:
        """Seconds from frame to frame."""
        return self.duration_s / self.frames


def motion_of_cycle(cycle: Cycle, rig: Rig, *, first: int = 0, frames: int | None = None) -> Motion:
    """Frames of a motion without end, from the ``first`` on, on one spot.

    Without a number, as often as is usual: the last frame is one before the first, so that they
    can be played in a loop.
    """
    count = cycle.times * cycle.frames if frames is None else frames
    numbers = np.arange(first, first + count) % cycle.frames
    moments = [cycle.moment(float(number) / cycle.frames) for number in numbers]
    poses = np.stack([angled_pose(rig, each.angles) for each in moments])
    poses[:, 0] = [_pelvis(each) for each in moments]
    return Motion(
        frame_time_s=cycle.frame_time_s,
        poses=poses,
        roots=np.zeros((len(poses), 3)),
        lifts_m=np.array([each.lift_m for each in moments]),
    )


def _pelvis(moment: Moment) -> Vector3:
    """The rotation vector of the pelvis: it leans first, and is turned then."""
    turn, lean = np.radians([moment.turn, moment.lean])
    about, forward = rotation_matrices(np.array([[0.0, turn, 0.0], [lean, 0.0, 0.0]]))
    return rotation_vectors((about @ forward)[None])[0]
