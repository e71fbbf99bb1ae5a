import numpy as np

from fitter.training.articulation.parts import PART_NAMES, part_index
from tests.accuracy.limbs_in_depth import wrong_limbs

JOINTS = np.random.default_rng(3).normal(size=(len(PART_NAMES), 3))


def _with_forearm_slanting(degrees: float) -> np.ndarray:
    joints = JOINTS.copy()
    angle = np.radians(degrees)
    joints[part_index("left_hand")] = joints[part_index("left_forearm")] + 0.25 * np.array(
        [0.0, np.cos(angle), np.sin(angle)]
    )
    return joints


def test_a_body_faces_as_itself_wherever_it_stands():
    assert wrong_limbs(JOINTS + [0.1, 0.2, 3.0], JOINTS) == ()


def test_a_mirrored_depth_turns_slanting_limbs_the_wrong_way():
    there, back = _with_forearm_slanting(25.0), _with_forearm_slanting(-25.0)
    assert wrong_limbs(there, back) == ("left_forearm",)


def test_a_limb_along_the_picture_may_slant_a_little_either_way():
    assert wrong_limbs(_with_forearm_slanting(8.0), _with_forearm_slanting(-8.0)) == ()
    assert wrong_limbs(_with_forearm_slanting(40.0), _with_forearm_slanting(10.0)) == ()
