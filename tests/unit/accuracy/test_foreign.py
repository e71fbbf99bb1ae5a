import numpy as np
import pytest

from tests.accuracy.foreign import (
    FOLDER,
    TRUE_NAMES,
    foreign_half,
    foreign_names,
    foreign_picture,
)
from tests.accuracy.joint_figures import part_of_joint
from tests.accuracy.scene import Half
from tests.shared_data import needs_shared


def test_later_pictures_are_reported():
    assert [foreign_half(name) for name in ("g01", "g14s", "g21", "g28")] == [
        Half.TUNING, Half.TUNING, Half.REPORTING, Half.REPORTING,
    ]  # fmt: skip


@needs_shared(FOLDER)
def test_both_halves_are_all_foreign_pictures():
    both = [name for half in Half for name in foreign_names(half)]
    assert sorted(both) == foreign_names()
    assert len(both) == len(set(both))


@needs_shared(FOLDER)
def test_a_foreign_picture_comes_with_its_truth():
    picture = foreign_picture("g11s")
    assert picture.person == foreign_picture("g11f").person
    assert picture.truth.measurements.keys() == TRUE_NAMES.keys()
    assert 27.5 < picture.truth.bmi < 28.5
    assert np.ptp(picture.truth.canonical[:, 1]) == pytest.approx(picture.truth.stature_m, abs=1e-6)
    knees = picture.joints[[part_of_joint("left_knee"), part_of_joint("right_knee")]]
    # Standing, the camera's y downward: knees lie between hips and ankles.
    assert (knees[:, 1] > picture.joints[part_of_joint("left_hip"), 1]).all()
    assert (knees[:, 1] < picture.joints[part_of_joint("left_ankle"), 1]).all()
