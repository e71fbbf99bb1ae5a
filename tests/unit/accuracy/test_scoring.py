"""Truths, distances and overlaps, by hand."""

import io
from dataclasses import asdict

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.observation.picture_files import read_exif
from fitter.observation.pixels import linear_from_display
from fitter.parameters import Light
from fitter.request import KnownMeasurement
from fitter.training.articulation.parts import PART_NAMES, part_index
from fitter.vocabulary.choices import Clothing, Gender, LightKind
from tests.accuracy.files import photograph, read_labels, write_labels
from tests.accuracy.foreign import FOLDER, TRUE_NAMES, foreign_half, foreign_names, foreign_picture
from tests.accuracy.scene import Half, Series
from tests.accuracy.scoring import light_error, overlap, resampled
from tests.accuracy.seen_labels import label_overlaps
from tests.accuracy.true_picture import Told, TruePicture, told_request
from tests.accuracy.truth import TrueBody, joint_error_mm, light_toward, part_of_joint, wrong_limbs
from tests.one_picture import one_picture
from tests.shared_data import needs_shared

JOINTS = np.random.default_rng(3).normal(size=(len(PART_NAMES), 3))

PICTURE = TruePicture(
    name="picture",
    person="somebody",
    series=Series.FOREIGN,
    half=Half.TUNING,
    request=one_picture(
        image=b"", clicks={}, gender=Gender.MALE, height_m=1.8, focal_length_35mm=50.0
    ),
    body_mask=np.zeros((4, 3), dtype=np.bool_),
    person_mask=np.zeros((4, 3), dtype=np.bool_),
    focal_length_px=900.0,
    light=Light(kind=LightKind.POINT, azimuth=0.5, elevation=0.3, distance=2.0),
    joints=np.full((17, 3), np.nan),
    truth=TrueBody(
        canonical=np.zeros((3, 3)),
        triangles=np.array([[0, 1, 2]]),
        measurements={"weight": 81.0, "chest_girth": 100.0},
        stature_m=1.8,
    ),
)


def with_forearm_slanting(degrees: float) -> np.ndarray:
    joints = JOINTS.copy()
    angle = np.radians(degrees)
    joints[part_index("left_hand")] = joints[part_index("left_forearm")] + 0.25 * np.array(
        [0.0, np.cos(angle), np.sin(angle)]
    )
    return joints


def test_joints_err_among_themselves_wherever_the_body_stands():
    moved = JOINTS + [0.1, 0.2, 3.0]
    assert joint_error_mm(moved, JOINTS) == pytest.approx(0.0, abs=1e-9)
    assert wrong_limbs(moved, JOINTS) == ()
    away = JOINTS.copy()
    away[part_index("head")] += [0.0, 0.017, 0.0]
    assert joint_error_mm(away, JOINTS) == pytest.approx(1.0)


def test_a_mirrored_depth_turns_slanting_limbs_the_wrong_way():
    there, back = with_forearm_slanting(25.0), with_forearm_slanting(-25.0)
    assert wrong_limbs(there, back) == ("left_forearm",)
    assert wrong_limbs(with_forearm_slanting(8.0), with_forearm_slanting(-8.0)) == ()


def test_a_mask_at_half_size_covers_the_same_share_at_full_size():
    half = np.zeros((10, 8), dtype=bool)
    half[3:7, 2:6] = True
    full = resampled(half, 0.5, (20, 16))
    assert full.mean() == half.mean()
    assert full[6:14, 4:12].all()
    assert overlap(full, np.roll(full, 4, axis=1)) == pytest.approx(1 / 3)


def test_lights_err_by_the_angle_between_them():
    ahead, aside = (
        light_toward(np.array(toward), LightKind.POINT)
        for toward in ((0.0, 0.0, -2.0), (3.0, 0.0, -3.0))
    )
    assert light_error(ahead, aside) == pytest.approx(45.0)
    assert light_error(ahead, None) is None


def test_a_fit_is_told_the_truth_and_nothing_else():
    assert PICTURE.truth.bmi == 25.0
    assert asdict(told_request(PICTURE, Told())) == asdict(PICTURE.request)
    asked = told_request(PICTURE, Told(focal_length=True, measurements=("weight",)))
    (view,) = asked.views
    assert (view.focal_length_px, view.focal_length_35mm) == (900.0, None)
    assert asked.person.measurements == {"weight": KnownMeasurement(value=81.0)}
    (view,) = told_request(PICTURE, Told(mask=True, clothing=Clothing.LOOSE, proposed=True)).views
    assert view.mask is not None
    assert view.clothing is Clothing.LOOSE
    assert view.complete_clicks
    assert not view.clicks


def labels(*rows: str) -> np.ndarray:
    return np.array([[int(each) for each in row] for row in rows], dtype=np.uint8)


def test_what_is_alike_overlaps_wholly_and_what_nobody_wears_is_left_out():
    overlaps = label_overlaps(labels("0114", "2155"), labels("0113", "2134"))
    assert overlaps == {"skin": 1.0, "hair": 1.0, "cloth": 1.0, "shoes": None}


def test_cloth_taken_for_skin_costs_both():
    overlaps = label_overlaps(labels("1114"), labels("1133"))
    assert overlaps["skin"] == pytest.approx(2 / 3)
    assert overlaps["cloth"] == pytest.approx(1 / 2)


def test_labels_are_read_as_they_were_written(tmp_path):
    written = np.arange(6, dtype=np.uint8).reshape(2, 3)
    write_labels(tmp_path / "labels.png", written)
    np.testing.assert_array_equal(read_labels(tmp_path / "labels.png"), written)


def test_noise_and_compression_leave_mean_light_as_it_was():
    linear = np.tile(np.array([0.05, 0.2, 0.7]), (64, 64, 1))
    file = photograph(linear, quality=100, equivalent_mm=50, rng=np.random.default_rng(0))
    picture = PillowImage.open(io.BytesIO(file))
    display = np.asarray(picture, dtype=float) / 255.0
    np.testing.assert_allclose(
        linear_from_display(display).mean(axis=(0, 1)), linear[0, 0], rtol=0.02
    )
    assert read_exif(picture).focal_length_35mm == 50.0


@needs_shared(FOLDER)
def test_a_foreign_picture_comes_with_its_truth():
    assert [foreign_half(name) for name in ("g14s", "g21")] == [Half.TUNING, Half.REPORTING]
    assert sorted(name for half in Half for name in foreign_names(half)) == foreign_names()
    picture = foreign_picture("g11s")
    assert picture.person == foreign_picture("g11f").person
    assert picture.truth.measurements.keys() == TRUE_NAMES.keys()
    assert 27.5 < picture.truth.bmi < 28.5
    assert np.ptp(picture.truth.canonical[:, 1]) == pytest.approx(picture.truth.stature_m, abs=1e-6)
    knees = picture.joints[[part_of_joint("left_knee"), part_of_joint("right_knee")]]
    # Standing, the camera's y downward: knees lie between hips and ankles.
    assert (knees[:, 1] > picture.joints[part_of_joint("left_hip"), 1]).all()
    assert (knees[:, 1] < picture.joints[part_of_joint("left_ankle"), 1]).all()
