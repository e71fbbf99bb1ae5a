"""Where arms reach, in classes: how well shoulders bend depends on little else."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fitter.arrays import Pose
from fitter.training.articulation.part_tree import part_index
from fitter.training.articulation.random_poses import SIDES, aimed_limb
from fitter.training.articulation.rig_drives import rest_axis

TWIST_DEGREES = (-45.0, 45.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmReach:
    """Directions of the upper arm in the trunk's frame, degrees, (lowest, highest).

    ``elevation`` is from straight down, ``azimuth`` from straight out, forward positive.
    """

    elevation: tuple[float, float]
    azimuth: tuple[float, float] = (-30.0, 100.0)


ARM_REACHES: Mapping[str, ArmReach] = {
    "0 to 60 degrees": ArmReach(elevation=(0.0, 60.0)),
    "60 to 90 degrees": ArmReach(elevation=(60.0, 90.0)),
    "90 to 120 degrees": ArmReach(elevation=(90.0, 120.0)),
    "120 to 150 degrees": ArmReach(elevation=(120.0, 150.0)),
    "150 to 175 degrees": ArmReach(elevation=(150.0, 175.0)),
    "reaching forward": ArmReach(elevation=(60.0, 110.0), azimuth=(70.0, 100.0)),
    "crossed in front": ArmReach(elevation=(50.0, 100.0), azimuth=(100.0, 130.0)),
}


def with_arms_reaching(pose: Pose, reach: ArmReach, rng: np.random.Generator) -> Pose:
    """The pose with both upper arms along directions of their own, out of one class."""
    reaching = pose.copy()
    axis = rest_axis("left_upper_arm")
    for side, mirror in SIDES.items():
        turn = aimed_limb(rng, axis, reach.elevation, reach.azimuth, TWIST_DEGREES)
        reaching[part_index(f"{side}_upper_arm")] = turn * mirror
    return reaching
