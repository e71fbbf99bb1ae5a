from itertools import islice

import numpy as np

from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.parts import part_index
from fitter.training.articulation.poses import EVERY, REACHES, taught_poses
from fitter.training.articulation.rig_drives import rest_axis

ROUND = EVERY * len(REACHES)


def poses(count: int) -> np.ndarray:
    return np.stack(list(islice(taught_poses(np.random.default_rng(5)), count)))


def elevations(of: np.ndarray) -> np.ndarray:
    turns = rotation_matrices(of[:, part_index("left_upper_arm")])
    return np.degrees(np.arccos(-(turns @ rest_axis("left_upper_arm"))[:, 1]))


def test_every_class_of_reaches_has_its_turn():
    found = elevations(poses(3 * ROUND)[::EVERY])
    for number, reach in enumerate(REACHES):
        of_class = found[number :: len(REACHES)]
        assert reach.elevation[0] <= of_class.min() <= of_class.max() <= reach.elevation[1]


def test_many_poses_have_arms_overhead_and_most_are_any():
    found = elevations(poses(50 * ROUND))
    assert 0.2 < np.mean(found > 100.0) < 0.6
    assert np.mean(found < 60.0) > 0.25


def test_one_seed_gives_the_same_poses():
    np.testing.assert_array_equal(poses(5), poses(5))
