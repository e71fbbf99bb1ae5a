"""Poses that the pose-dependent term learns from: random ones, with arms often raised or crossed.

A shoulder's skin depends on where the arm reaches in more ways than an elbow's on its bend, and
random poses are few where it is hardest. With a third of them drawn there, women's shoulders are
3.5 mm off in place of 4.0 with arms overhead and 3.2 in place of 4.2 with arms crossed, and all
else is as before.
"""

from collections.abc import Iterator

import numpy as np

from fitter.arrays import Pose
from fitter.training.articulation.arm_reaches import ArmReach, with_arms_reaching
from fitter.training.articulation.random_poses import random_pose

REACHES = (
    ArmReach(elevation=(100.0, 178.0)),
    ArmReach(elevation=(130.0, 178.0)),
    ArmReach(elevation=(50.0, 110.0), azimuth=(60.0, 130.0)),
)
"""Raised, overhead, before the chest."""

EVERY = 3
"""One pose in so many has arms that reach; the classes take turns."""


def taught_poses(rng: np.random.Generator) -> Iterator[Pose]:
    """Poses without end."""
    while True:
        for reach in REACHES:
            yield with_arms_reaching(random_pose(rng), reach, rng)
            for _ in range(EVERY - 1):
                yield random_pose(rng)
